#include "core/model/impurities.h"

#include <algorithm>
#include <numeric>

#include "core/base/counter_rng.h"

namespace cleave {
namespace {

// A number in (0, 1) for every edge of the solver, by the client's ids of its nodes.
std::vector<double> EdgeDraws(uint64_t seed, RandomStream stream, const MeshOrder& order,
                              const Incidence& incidence) {
  std::vector<double> draws;
  draws.reserve(incidence.edges.size());
  for (const auto& [a, b] : incidence.edges) {
    const auto [small, large] =
        std::minmax(order.old_node[static_cast<size_t>(a)], order.old_node[static_cast<size_t>(b)]);
    draws.push_back(
        UniformDraw(seed, stream, static_cast<uint64_t>(small), static_cast<uint64_t>(large)));
  }
  return draws;
}

}  // namespace

ImpurityPart BuildImpurities(const Scene& scene, std::span<const double> potencies,
                             const MeshOrder& order, const Incidence& incidence) {
  const Impurities& impurities = *scene.impurities;
  ImpurityPart part;
  const double usual_weight = impurities.effect == ImpurityEffect::kUpgradation ? 0.2 : 1;
  part.settings = {impurities.effect, impurities.steepness, impurities.pure_offset,
                   impurities.degree_weight.value_or(usual_weight),
                   impurities.model == ImpurityModel::kGraph};

  part.potencies.resize(potencies.size());
  for (size_t node = 0; node < potencies.size(); ++node)
    part.potencies[static_cast<size_t>(order.new_node[node])] = potencies[node];

  if (impurities.mode == ImpurityMode::kSampled)
    part.edge_draws = EdgeDraws(scene.seed, RandomStream::kEdgeDraw, order, incidence);
  if (impurities.model == ImpurityModel::kUncorrelated) {
    // The edge of a random rank gives its strength to the next edge in a fixed order: the client's,
    // so that the deal does not depend on the solver's.
    const std::vector<double> draws =
        EdgeDraws(scene.seed, RandomStream::kEdgeDeal, order, incidence);
    std::vector<int32_t> by_draw(draws.size());
    std::iota(by_draw.begin(), by_draw.end(), 0);
    std::vector<int32_t> by_client = by_draw;
    std::sort(by_draw.begin(), by_draw.end(), [&](int32_t a, int32_t b) {
      return draws[static_cast<size_t>(a)] < draws[static_cast<size_t>(b)];
    });
    const auto client_ends = [&](int32_t edge) {
      const auto [a, b] = incidence.edges[static_cast<size_t>(edge)];
      return std::minmax(
          {order.old_node[static_cast<size_t>(a)], order.old_node[static_cast<size_t>(b)]});
    };
    std::sort(by_client.begin(), by_client.end(),
              [&](int32_t a, int32_t b) { return client_ends(a) < client_ends(b); });
    part.edge_deal.resize(draws.size());
    for (size_t rank = 0; rank < draws.size(); ++rank)
      part.edge_deal[static_cast<size_t>(by_client[rank])] = by_draw[rank];
  }
  return part;
}

}  // namespace cleave
