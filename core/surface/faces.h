#ifndef CLEAVE_CORE_SURFACE_FACES_H_
#define CLEAVE_CORE_SURFACE_FACES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/tet_mesh.h"

namespace cleave {

// For edge k of a tet (kTetEdges), the other two vertices, so that (ends of k, these) is an even
// permutation: seen along the edge, they turn clockwise.
inline constexpr std::array<std::array<size_t, 2>, 6> kAcrossEdge = {
    {{2, 3}, {3, 1}, {1, 2}, {0, 3}, {2, 0}, {0, 1}}};

// A side of a tet: face k of kTetFaces.
struct TetFace {
  int32_t tet = 0;
  int32_t face = 0;
};

// Which tets share a face. Depends on the mesh only: build it once, use it for every frame.
struct Faces {
  // Across each face of each tet: 4 * the neighbour + its face, or -1 on the boundary.
  std::vector<std::array<int32_t, 4>> neighbors;
  std::vector<TetFace> boundary;  // ascending by tet, then face
};

// Precondition: no face belongs to more than two tets (mesh_check.h).
Faces BuildFaces(const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_FACES_H_
