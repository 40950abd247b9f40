#ifndef CLEAVE_CORE_MESH_PLACED_POINTS_H_
#define CLEAVE_CORE_MESH_PLACED_POINTS_H_

#include <cstdint>
#include <vector>

#include "core/mesh/body.h"

namespace cleave {

// What binds a node to the surface of its body.
struct Binding {
  uint8_t fixed_axes = 0;  // bit a: coordinate a never changes
  double radius = 0;       // m; > 0: the node stays at this distance from the z axis

  bool inside() const { return fixed_axes == 0 && radius == 0; }
  // On one flat or round side, not on an edge or a corner between sides.
  bool on_one_side() const {
    return radius > 0 ? fixed_axes == 0 : fixed_axes == 1 || fixed_axes == 2 || fixed_axes == 4;
  }
};

struct PlacedPoints {
  std::vector<Vec3> positions;  // m
  std::vector<Binding> bindings;
};

// Where a bound node at `from` ends up when it is moved to `to`.
Vec3 Bound(const Binding& binding, const Vec3& from, const Vec3& to);

// Random points in a body and on its surface for a mesh of edges about `cell_size` long: even steps
// along edges and rims, then no two points within 0.7 cell sizes, first on the sides and then
// inside, at least half a cell from the surface (Poisson-disk sampling by dart throwing, Cook
// 1986). Precondition: every extent of the body, wall and height included, is at least about a
// cell.
PlacedPoints PlacePoints(const Body& body, double cell_size, uint64_t seed);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_PLACED_POINTS_H_
