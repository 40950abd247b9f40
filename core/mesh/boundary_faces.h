#ifndef CLEAVE_CORE_MESH_BOUNDARY_FACES_H_
#define CLEAVE_CORE_MESH_BOUNDARY_FACES_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/tet_mesh.h"

namespace cleave {

// A face of the mesh's boundary.
struct BoundaryFace {
  std::array<int32_t, 3> nodes;  // turning outward
  int32_t tet;                   // the one that it belongs to
};

// The faces of one tet only whose nodes are all in `nodes` (ids in range, any order), ascending by
// tet, then by their place in kTetFaces. Precondition: tets have positive volume and distinct nodes
// in range.
std::vector<BoundaryFace> FindBoundaryFaces(const TetMesh& mesh, std::span<const int32_t> nodes);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_BOUNDARY_FACES_H_
