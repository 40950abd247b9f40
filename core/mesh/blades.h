#ifndef CLEAVE_CORE_MESH_BLADES_H_
#define CLEAVE_CORE_MESH_BLADES_H_

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/plane_grid.h"
#include "core/mesh/surface_depth.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// A straight part of a blade's edge.
struct BladeSegment {
  Vec3 start{0, 0, 0};                   // m
  Vec3 end{0, 0, 0};                     // m
  std::array<double, 2> radii = {0, 0};  // m, of the groove at start and end
};

// Curtains that segments draw along a direction, to the first `depth` below the surface that one
// sees looking along it. Where segments lie along the direction does not matter.
struct BladeSet {
  std::vector<BladeSegment> segments;
  Vec3 direction{0, 0, -1};                                // any length but 0
  double depth = std::numeric_limits<double>::infinity();  // m
};

// What blades cut of a mesh. Immutable; any thread may ask.
class Blades {
 public:
  // Preconditions: the mesh passed CheckMesh and outlives this object; numbers are finite but
  // depth, which is positive and may not be; the direction is not 0.
  Blades(BladeSet set, const TetMesh& mesh);

  // Whether each of the edges (node ids) crosses a blade, exactly (CrossesCurtain) but for depth,
  // which is that of the point where it crosses, to rounding.
  std::vector<uint8_t> CrossedEdges(std::span<const std::array<int32_t, 2>> edges) const;

  // Whether each of `curves` curves crosses any of the edges; `curve_of` names the curve of every
  // segment. Looks no farther once all do.
  std::vector<uint8_t> CrossingCurves(std::span<const std::array<int32_t, 2>> edges,
                                      std::span<const int32_t> curve_of, size_t curves) const;

  // Whether the groove of each of the curves holds a node. A curve without width has none.
  std::vector<uint8_t> HoldingCurves(std::span<const int32_t> curve_of, size_t curves) const;

  // How far every node is outside the grooves, m: across the direction, from the radius of the
  // closest point of a segment's line on; along it, below the depth. 0 inside; infinite from
  // `reach` on.
  std::vector<double> DistancesOutside(double reach) const;

 private:
  PlaneGrid SegmentGrid() const;
  PlaneGrid GrooveGrid(double reach) const;  // m round the grooves
  // How far a place in the plane is outside a segment's groove, m.
  double OutsideAcross(const BladeSegment& segment, const Vec2& at) const;
  bool Crosses(const BladeSegment& blade, const Vec3& a, const Vec3& b) const;

  const BladeSet set_;
  const TetMesh& mesh_;
  const PlaneView view_;
  const double margin_;                // m, above the rounding of places in the plane
  std::optional<SurfaceDepth> depth_;  // where blades end within the body
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_BLADES_H_
