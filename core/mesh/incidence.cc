#include "core/mesh/incidence.h"

#include <algorithm>

namespace cleave {
namespace {

// Rows of `items_of(item) -> row ids`, each row's items ascending because items are visited in
// order.
template <typename RowsOf>
Csr Transpose(int64_t rows, int64_t items, const RowsOf& rows_of) {
  Csr csr;
  csr.offsets.assign(static_cast<size_t>(rows) + 1, 0);
  for (int64_t item = 0; item < items; ++item) {
    for (const int32_t row : rows_of(item)) ++csr.offsets[static_cast<size_t>(row) + 1];
  }
  for (size_t row = 0; row < static_cast<size_t>(rows); ++row)
    csr.offsets[row + 1] += csr.offsets[row];
  csr.items.resize(static_cast<size_t>(csr.offsets.back()));
  std::vector<int32_t> next(csr.offsets.begin(), csr.offsets.end() - 1);
  for (int64_t item = 0; item < items; ++item) {
    for (const int32_t row : rows_of(item)) {
      csr.items[static_cast<size_t>(next[static_cast<size_t>(row)]++)] = static_cast<int32_t>(item);
    }
  }
  return csr;
}

}  // namespace

Incidence BuildIncidence(const TetMesh& mesh) {
  Incidence incidence;
  const auto tets = static_cast<size_t>(mesh.tet_count());

  // An edge as one sortable number, beside the tet corner pair that it comes from.
  struct Use {
    uint64_t key;
    uint32_t slot;  // 6 * tet + local edge
    bool operator<(const Use& other) const {
      return key != other.key ? key < other.key : slot < other.slot;
    }
  };
  std::vector<Use> uses(6 * tets);
  for (size_t tet = 0; tet < tets; ++tet) {
    for (size_t k = 0; k < 6; ++k) {
      const auto a = static_cast<uint32_t>(mesh.tets[tet][static_cast<size_t>(kTetEdges[k][0])]);
      const auto b = static_cast<uint32_t>(mesh.tets[tet][static_cast<size_t>(kTetEdges[k][1])]);
      uses[6 * tet + k] = {(uint64_t{std::min(a, b)} << 32) | std::max(a, b),
                           static_cast<uint32_t>(6 * tet + k)};
    }
  }
  std::sort(uses.begin(), uses.end());

  incidence.tet_edges.resize(tets);
  for (size_t use = 0; use < uses.size(); ++use) {
    if (use == 0 || uses[use].key != uses[use - 1].key) {
      incidence.edges.push_back({static_cast<int32_t>(uses[use].key >> 32),
                                 static_cast<int32_t>(uses[use].key & 0xFFFFFFFFu)});
    }
    incidence.tet_edges[uses[use].slot / 6][uses[use].slot % 6] =
        static_cast<int32_t>(incidence.edges.size() - 1);
  }

  incidence.node_edges = Transpose(mesh.node_count(), incidence.edge_count(), [&](int64_t edge) {
    return incidence.edges[static_cast<size_t>(edge)];
  });
  incidence.node_tets = Transpose(mesh.node_count(), mesh.tet_count(),
                                  [&](int64_t tet) { return mesh.tets[static_cast<size_t>(tet)]; });
  incidence.edge_tets = Transpose(incidence.edge_count(), mesh.tet_count(), [&](int64_t tet) {
    return incidence.tet_edges[static_cast<size_t>(tet)];
  });
  return incidence;
}

}  // namespace cleave
