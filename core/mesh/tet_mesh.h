#ifndef CLEAVE_CORE_MESH_TET_MESH_H_
#define CLEAVE_CORE_MESH_TET_MESH_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// The local edges of a tet, in the order in which masks number them: bit k of a tet's edge mask is
// edge kTetEdges[k].
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// The local faces of a tet, face k opposite to vertex k, each turning outward for a tet of positive
// volume.
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// A named part of a body, as a Gmsh physical group or a Vega set gives it.
struct MeshRegion {
  int32_t id = 0;
  std::string name;
};

// A tetrahedral mesh as the client sent it: ids are positions in these arrays and stay the client's
// ids everywhere outside the solver.
struct TetMesh {
  std::vector<Vec3> rest_positions;  // m, a node each
  std::vector<std::array<int32_t, 4>>
      tets;                          // node ids; positive volume once checked (mesh_check.h)
  std::vector<int32_t> tet_regions;  // a region id a tet, or empty: all of region 0
  std::vector<MeshRegion> regions;   // names of region ids; may be empty or partial

  int64_t node_count() const { return static_cast<int64_t>(rest_positions.size()); }
  int64_t tet_count() const { return static_cast<int64_t>(tets.size()); }
  int32_t region_of(int64_t tet) const {
    return tet_regions.empty() ? 0 : tet_regions[static_cast<size_t>(tet)];
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_TET_MESH_H_
