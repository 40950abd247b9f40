#ifndef CLEAVE_CORE_MESH_INCIDENCE_H_
#define CLEAVE_CORE_MESH_INCIDENCE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/tet_mesh.h"

namespace cleave {

// Lists of ids, one list a row, stored end to end.
struct Csr {
  std::vector<int32_t> offsets;  // rows + 1
  std::vector<int32_t> items;

  int64_t rows() const { return static_cast<int64_t>(offsets.size()) - 1; }
  std::span<const int32_t> operator[](int64_t row) const {
    const auto begin = static_cast<size_t>(offsets[static_cast<size_t>(row)]);
    const auto end = static_cast<size_t>(offsets[static_cast<size_t>(row) + 1]);
    return {items.data() + begin, end - begin};
  }
};

// Who touches whom in a mesh. Edge ids are positions in `edges`, which is sorted by (smaller node,
// larger node): anyone with the mesh derives the same ids, so they may cross the wire.
struct Incidence {
  std::vector<std::array<int32_t, 2>> edges;      // node ids, smaller first
  std::vector<std::array<int32_t, 6>> tet_edges;  // edge ids in the order of kTetEdges
  Csr node_edges;                                 // ascending edge ids
  Csr node_tets;                                  // ascending tet ids
  Csr edge_tets;                                  // ascending tet ids

  int64_t edge_count() const { return static_cast<int64_t>(edges.size()); }
};

// Precondition: every node id of every tet is in range and no tet names a node twice
// (mesh_check.h); 6 * tet count fits in 31 bits (mesh_limits.h).
Incidence BuildIncidence(const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_INCIDENCE_H_
