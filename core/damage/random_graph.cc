#include "core/damage/random_graph.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace cleave {
namespace {

// Beyond it strength no longer changes, and products stay finite.
constexpr double kMaxPotency = 1e6;

}  // namespace

BondStrength::BondStrength(const RandomGraphSettings& settings) : settings_(settings) {
  const double pure = Weight(0, 1);
  pure_ = std::tanh(pure * pure / (2 * settings.steepness));
  const bool upgrades = settings.effect == ImpurityEffect::kUpgradation;
  extreme_ = (upgrades ? 1 : std::tanh(1 / (2 * settings.steepness))) / pure_;
}

double BondStrength::Weight(double potency, double share) const {
  const double size = std::min(std::abs(potency), kMaxPotency);
  const double left = 1 - settings_.degree_weight * (1 - share);
  return settings_.effect == ImpurityEffect::kUpgradation
             ? left + size
             : left + 1 / (settings_.pure_offset + size);
}

double BondStrength::operator()(double potency_i, double potency_j, double share_i,
                                double share_j) const {
  return std::tanh(Weight(potency_i, share_i) * Weight(potency_j, share_j) /
                   (2 * settings_.steepness)) /
         pure_;
}

RandomGraph::RandomGraph(const Incidence& incidence, const RandomGraphSettings& settings,
                         std::span<const double> potencies, std::span<const double> draws,
                         std::span<const int32_t> deal)
    : incidence_(incidence),
      strength_(settings),
      upgrades_(settings.effect == ImpurityEffect::kUpgradation),
      follows_degrees_(settings.follows_degrees),
      potencies_(potencies),
      draws_(draws),
      deal_(deal),
      degrees_(settings.follows_degrees ? potencies.size() : 0),
      factors_(incidence.edges.size()) {
  Reset({});
}

double RandomGraph::FactorOf(int32_t edge) const {
  const int32_t bond = deal_.empty() ? edge : deal_[static_cast<size_t>(edge)];
  const auto [i, j] = incidence_.edges[static_cast<size_t>(bond)];
  const auto share = [&](int32_t node) {
    // A node without bonds has only broken edges, which nobody asks about.
    if (!follows_degrees_ || degrees_[static_cast<size_t>(node)] == 0) return 1.0;
    return degrees_[static_cast<size_t>(node)] /
           static_cast<double>(incidence_.node_edges[node].size());
  };
  const double kappa = strength_(potencies_[static_cast<size_t>(i)],
                                 potencies_[static_cast<size_t>(j)], share(i), share(j));
  if (draws_.empty()) return kappa;
  const double draw = draws_[static_cast<size_t>(edge)];
  const double extreme = strength_.extreme();
  const bool is_extreme = upgrades_ ? draw < (kappa - 1) / (extreme - 1) : draw < 1 - kappa;
  return is_extreme ? extreme : 1;
}

std::span<const int32_t> RandomGraph::Break(std::span<const int32_t> edges) {
  changed_.clear();
  if (!follows_degrees_) return changed_;
  for (const int32_t edge : edges) {
    for (const int32_t node : incidence_.edges[static_cast<size_t>(edge)]) {
      --degrees_[static_cast<size_t>(node)];
      const auto at_node = incidence_.node_edges[node];
      changed_.insert(changed_.end(), at_node.begin(), at_node.end());
    }
  }
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  for (const int32_t edge : changed_) factors_[static_cast<size_t>(edge)] = FactorOf(edge);
  return changed_;
}

void RandomGraph::Reset(std::span<const uint8_t> broken) {
  for (size_t node = 0; node < degrees_.size(); ++node) {
    int32_t bonds = 0;
    for (const int32_t edge : incidence_.node_edges[static_cast<int64_t>(node)])
      bonds += broken.empty() || broken[static_cast<size_t>(edge)] == 0 ? 1 : 0;
    degrees_[node] = bonds;
  }
  ParallelFor(incidence_.edge_count(), 1024, [&](int64_t begin, int64_t end) {
    for (int64_t edge = begin; edge < end; ++edge)
      factors_[static_cast<size_t>(edge)] = FactorOf(static_cast<int32_t>(edge));
  });
}

int64_t RandomGraph::bytes() const {
  return static_cast<int64_t>(degrees_.size() * sizeof(int32_t) + factors_.size() * sizeof(double));
}

}  // namespace cleave
