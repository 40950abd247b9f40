#ifndef CLEAVE_CLIENT_IO_BAKE_NORMAL_GROUPS_H_
#define CLEAVE_CLIENT_IO_BAKE_NORMAL_GROUPS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/incidence.h"
#include "core/surface/surface_topology.h"

namespace cleave {

// Which corners of a surface share a normal in every frame: those of a point whose triangles are
// smooth there at rest, as CornerNormals has it. A normal is the area-weighted mean over the
// triangles of its group. Thread-safe once made; loops run on the caller's TBB arena.
class NormalGroups {
 public:
  // Takes from `topology` what it needs but triangles, which must outlive this object.
  explicit NormalGroups(const SurfaceTopology& topology);

  int32_t count() const { return static_cast<int32_t>(members_.rows()); }
  int32_t group(size_t triangle, size_t corner) const { return groups_[triangle][corner]; }
  // Of length 1, a group each, with the points where they are (m). A group whose triangles have no
  // area together has the normal that it has at rest, or z.
  void Find(const std::vector<Vec3>& points, std::vector<std::array<float, 3>>& normals) const;

 private:
  const std::vector<std::array<int32_t, 3>>& triangles_;
  std::vector<std::array<int32_t, 3>> groups_;  // of corners, a triangle each
  Csr members_;                                 // triangles, a group each
  std::vector<std::array<float, 3>> rest_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_NORMAL_GROUPS_H_
