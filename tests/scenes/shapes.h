#ifndef CLEAVE_TESTS_SCENES_SHAPES_H_
#define CLEAVE_TESTS_SCENES_SHAPES_H_

#include <span>

#include "absl/status/statusor.h"
#include "core/base/vec3.h"
#include "core/mesh/procedural_shapes.h"
#include "core/mesh/tet_mesh.h"

// Bodies that Cleave does not mesh by itself: its boxes and cylinders, warped. All are meshed in
// either layout and pass CheckAndOrientMesh without an error; lengths in metres.

namespace cleave {

// |x/a|^n + |y/b|^n <= 1 in plan, a and b half of `size`, of even thickness; about the origin.
absl::StatusOr<TetMesh> SuperellipseSlab(const Vec3& size, double exponent,
                                         const MeshResolution& resolution);

// |x/a|^n + |y/b|^n + |z/c|^n <= 1; about the origin. Depth below the surface as a share of the
// half size, 0 at the surface and 1 in the middle, is SuperellipsoidDepth.
absl::StatusOr<TetMesh> SuperellipsoidLoaf(const Vec3& size, double exponent,
                                           const MeshResolution& resolution);
double SuperellipsoidDepth(const Vec3& position, const Vec3& size, double exponent);

// A tapered stick along z from the origin, with the stubs of two twigs.
struct BranchShape {
  double length = 0.6;
  double foot_radius = 0.05;
  double tip_radius = 0.036;
  double stub_height = 0.03;  // beyond the bark
};
absl::StatusOr<TetMesh> Branch(const BranchShape& shape, const MeshResolution& resolution);

// A column along z from the origin, 1 m high and 0.1 m in radius, with a base and a capital.
absl::StatusOr<TetMesh> Column(const MeshResolution& resolution);

// A cylinder with round ends, all points within `radius` (m) of a segment.
struct Capsule {
  Vec3 from{0, 0, 0};  // m
  Vec3 to{0, 0, 0};    // m
  double radius = 0;   // m
};
// All that is in any of the capsules. Precondition: at least one.
absl::StatusOr<TetMesh> Capsules(std::span<const Capsule> capsules,
                                 const MeshResolution& resolution);

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_SHAPES_H_
