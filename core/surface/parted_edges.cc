#include "core/surface/parted_edges.h"

#include <algorithm>
#include <cstddef>

namespace cleave {

void BreakInTets(const Incidence& incidence, std::span<const int32_t> edges,
                 std::vector<EdgeMask>& tet_masks, std::vector<int32_t>& parted) {
  parted.clear();
  for (const int32_t edge : edges) {
    for (const int32_t around : incidence.edge_tets[edge]) {
      const auto tet = static_cast<size_t>(around);
      EdgeMask& mask = tet_masks[tet];
      const EdgeMask before = mask;
      for (size_t k = 0; k < 6; ++k) {
        if (incidence.tet_edges[tet][k] == edge) mask |= static_cast<EdgeMask>(1u << k);
      }
      if (kVertexGroups[mask].count == kVertexGroups[before].count) continue;
      for (size_t k = 0; k < 6; ++k) {
        if (PartsEdge(mask, k) && !PartsEdge(before, k))
          parted.push_back(incidence.tet_edges[tet][k]);
      }
    }
  }
  std::sort(parted.begin(), parted.end());
  parted.erase(std::unique(parted.begin(), parted.end()), parted.end());
}

}  // namespace cleave
