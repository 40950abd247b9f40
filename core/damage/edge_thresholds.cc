#include "core/damage/edge_thresholds.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>

#include "core/damage/edge_stress.h"

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

std::vector<double> EdgeThresholds(const TetMesh& mesh, const Incidence& incidence,
                                   std::span<const double> tet_strengths,
                                   std::span<const DirectionalStrength> directional) {
  std::vector<std::array<double, 6>> factors(mesh.tets.size(), {1, 1, 1, 1, 1, 1});
  for (const DirectionalStrength& strength : directional) {
    const auto tet = static_cast<size_t>(strength.tet);
    for (size_t k = 0; k < 6; ++k) {
      const auto& nodes = incidence.edges[static_cast<size_t>(incidence.tet_edges[tet][k])];
      const EdgeDirections edge(nodes, mesh.rest_positions, mesh.rest_positions);
      const double cosine = edge.rest.dot(Eigen::Vector3d(strength.direction.data()));
      factors[tet][k] =
          std::max(factors[tet][k], DirectionalStrengthFactor(strength.ratio, cosine));
    }
  }
  std::vector<double> thresholds(incidence.edges.size(), std::numeric_limits<double>::infinity());
  for (size_t tet = 0; tet < factors.size(); ++tet) {
    for (size_t k = 0; k < 6; ++k) {
      double& threshold = thresholds[static_cast<size_t>(incidence.tet_edges[tet][k])];
      threshold = std::min(threshold, tet_strengths[tet] * factors[tet][k]);
    }
  }
  return thresholds;
}

}  // namespace cleave
