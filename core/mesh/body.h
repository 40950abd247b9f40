#ifndef CLEAVE_CORE_MESH_BODY_H_
#define CLEAVE_CORE_MESH_BODY_H_

#include <cstdint>

#include "core/base/vec3.h"
#include "core/mesh/procedural_shapes.h"

namespace cleave {

// A procedural shape at its own origin, as the mesh makers see it: a box with its smallest corner
// there, or a cylinder along z, hollow when inner_radius > 0, with the centre of its base there.
struct Body {
  bool round = false;
  Vec3 size{0, 0, 0};       // m; of a round body only z, its height, counts
  double outer_radius = 0;  // m
  double inner_radius = 0;  // m
  int32_t min_layers = 1;   // fewest cells along z
};

Body BodyOf(const BoxMesh& shape);
Body BodyOf(const CylinderMesh& shape);
Body BodyOf(const TubeMesh& shape);
Body BodyOf(const DiscMesh& shape);

// m^3
double VolumeOf(const Body& body);

// Cells of about `cell_size` along `length`, at least `fewest`.
int64_t CellsAlong(double length, double cell_size, int64_t fewest);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_BODY_H_
