#include "core/damage/edge_thresholds.h"

#include <algorithm>
#include <limits>

namespace cleave {

std::vector<double> EdgeThresholds(const Incidence& incidence,
                                   std::span<const double> tet_strengths) {
  std::vector<double> thresholds(incidence.edges.size(), std::numeric_limits<double>::infinity());
  for (size_t tet = 0; tet < incidence.tet_edges.size(); ++tet) {
    for (const int32_t edge : incidence.tet_edges[tet]) {
      double& threshold = thresholds[static_cast<size_t>(edge)];
      threshold = std::min(threshold, tet_strengths[tet]);
    }
  }
  return thresholds;
}

}  // namespace cleave
