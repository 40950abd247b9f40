#include "core/damage/edge_mask.h"

namespace cleave {

std::vector<EdgeMask> TetEdgeMasks(const Incidence& incidence,
                                   std::span<const int32_t> broken_edges) {
  std::vector<EdgeMask> masks(incidence.tet_edges.size(), 0);
  for (const int32_t edge : broken_edges) {
    for (const int32_t tet : incidence.edge_tets[edge]) {
      const std::array<int32_t, 6>& edges = incidence.tet_edges[static_cast<size_t>(tet)];
      for (size_t k = 0; k < 6; ++k) {
        if (edges[k] == edge) masks[static_cast<size_t>(tet)] |= static_cast<EdgeMask>(1u << k);
      }
    }
  }
  return masks;
}

}  // namespace cleave
