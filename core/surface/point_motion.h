#ifndef CLEAVE_CORE_SURFACE_POINT_MOTION_H_
#define CLEAVE_CORE_SURFACE_POINT_MOTION_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/surface_topology.h"

namespace cleave {

// Carries the points of visible surfaces along with the nodes, frame after frame.
//
// A point that all of its nodes own moves as their weighted mean. Another copy, and a point off its
// nodes, moves with the nodes on its side: the mean over them of x_v + F_v (X_p - X_v), F_v the
// volume-weighted mean deformation gradient of the live tets at v, its singular values held within
// [0.2, 5] because a crack's neighbours may be badly distorted. (The split tet's own gradient tells
// how far the pieces are apart, not how they are deformed.) A node that has lost its last live tet
// keeps the last F_v that it had; one that had none, since all of its tets came apart at once, is
// undeformed and turned as they are on the mean. Source: method note, section 8.
//
// It reads the nodes of the boundary, those of separated tets and whatever shares a tet with these:
// what a surface view carries (core/stream/FORMAT.md, 7.5).
//
// Not thread-safe; loops run on the caller's TBB arena.
class PointMotion {
 public:
  // `mesh` and `incidence` must outlive this object.
  PointMotion(const TetMesh& mesh, const Incidence& incidence);

  // Where the points of `surface` are (m) when the nodes are at `positions` (m, a node each).
  // Frames come in order; each may have its own surface, of this mesh.
  void Move(const SurfaceTopology& surface, std::span<const Vec3> positions,
            std::vector<Vec3>& points);

 private:
  using Gradient = std::array<double, 9>;  // column by column

  // Brings `gradients_` up to date for the nodes that own a copy among several.
  void UpdateGradients(const SurfaceTopology& surface, std::span<const Vec3> positions);

  const TetMesh& mesh_;
  const Incidence& incidence_;
  std::vector<Gradient> gradients_;    // a node each
  std::vector<uint8_t> has_gradient_;  // a node each
  std::vector<int32_t> owner_nodes_;   // scratch
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_POINT_MOTION_H_
