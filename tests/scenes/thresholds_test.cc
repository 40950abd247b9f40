// How impurities make thresholds, exactly, on a mesh of three tets and on random meshes (the
// paper's Fig. 4), and that a node's impurity reaches its own edges only (sec. 5).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/damage/random_graph.h"
#include "core/mesh/incidence.h"
#include "core/mesh/procedural.h"

namespace cleave {
namespace {

// Three tets round the edge from node 0 to node 1: all of its neighbours have it in common.
TetMesh ThreeTets() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-0.5, 0.9, 0}, {-0.5, -0.9, 0}};
  mesh.tets = {{0, 2, 3, 1}, {0, 3, 4, 1}, {0, 4, 2, 1}};
  return mesh;
}

TetMesh RandomMesh(uint32_t seed) {
  BoxMesh box;
  box.size = {1, 0.6, 0.5};
  box.resolution.cell_size = 0.2;
  box.resolution.seed = seed;
  return *BuildMesh(box);
}

// How many times the strength of the pure body every edge has.
std::vector<double> Thresholds(const Incidence& incidence, const RandomGraphSettings& settings,
                               const std::vector<double>& potencies,
                               const std::vector<int32_t>& broken = {}) {
  RandomGraph graph(incidence, settings, potencies, {}, {});
  graph.Break(broken);
  return {graph.factors().begin(), graph.factors().end()};
}

RandomGraphSettings SettingsOf(ImpurityEffect effect) {
  RandomGraphSettings settings;
  settings.effect = effect;
  return settings;
}

constexpr std::array kEffects = {ImpurityEffect::kDegradation, ImpurityEffect::kUpgradation};

TEST(ThresholdsDemonstration, BothOneAndNoEndImpureMakeThreeTiers) {
  const Incidence incidence = BuildIncidence(ThreeTets());
  ASSERT_EQ(incidence.edges[0], (std::array<int32_t, 2>{0, 1}));
  for (const ImpurityEffect effect : kEffects) {
    for (const double potency : {0.1, 0.5, 1.0, 10.0, 100.0}) {
      const RandomGraphSettings settings = SettingsOf(effect);
      const double none = Thresholds(incidence, settings, {0, 0, 0, 0, 0})[0];
      const double one = Thresholds(incidence, settings, {potency, 0, 0, 0, 0})[0];
      const double both = Thresholds(incidence, settings, {potency, potency, 0, 0, 0})[0];
      if (effect == ImpurityEffect::kDegradation) {
        EXPECT_LT(both, one) << potency;
        EXPECT_LT(one, none) << potency;
        EXPECT_DOUBLE_EQ(none, 1);
      } else {
        EXPECT_GT(both, one) << potency;
        EXPECT_GT(one, none) << potency;
      }
    }
  }
}

TEST(ThresholdsDemonstration, APotencyMovesItsOwnEdgesOnlyAndAllOneWay) {
  for (uint32_t seed = 1; seed <= 8; ++seed) {
    const Incidence incidence = BuildIncidence(RandomMesh(seed));
    const auto nodes = static_cast<size_t>(incidence.node_edges.rows());
    std::vector<double> potencies;
    for (size_t node = 0; node < nodes; ++node)
      potencies.push_back(3 * UniformDraw(seed, RandomStream::kNodeNoise, node, 0));
    for (const ImpurityEffect effect : kEffects) {
      const RandomGraphSettings settings = SettingsOf(effect);
      const std::vector<double> before = Thresholds(incidence, settings, potencies);
      for (size_t node = seed % 5; node < nodes; node += 5) {
        std::vector<double> changed = potencies;
        changed[node] += 0.5;
        const std::vector<double> after = Thresholds(incidence, settings, changed);
        for (size_t edge = 0; edge < after.size(); ++edge) {
          const auto& [a, b] = incidence.edges[edge];
          const bool own = static_cast<size_t>(a) == node || static_cast<size_t>(b) == node;
          if (!own) {
            ASSERT_EQ(after[edge], before[edge]);
          } else if (effect == ImpurityEffect::kDegradation) {
            ASSERT_LT(after[edge], before[edge]);
          } else {
            ASSERT_GT(after[edge], before[edge]);
          }
        }
      }
    }
  }
}

TEST(ThresholdsDemonstration, ALostBondWeakensTheBondsOfItsNodesOnly) {
  for (uint32_t seed = 1; seed <= 8; ++seed) {
    const Incidence incidence = BuildIncidence(RandomMesh(seed));
    std::vector<double> potencies;
    for (int64_t node = 0; node < incidence.node_edges.rows(); ++node)
      potencies.push_back(
          3 * UniformDraw(seed, RandomStream::kNodeNoise, static_cast<uint64_t>(node), 1));
    for (const ImpurityEffect effect : kEffects) {
      const RandomGraphSettings settings = SettingsOf(effect);
      const std::vector<double> whole = Thresholds(incidence, settings, potencies);
      const auto lost = static_cast<int32_t>(seed * 7);
      const std::vector<double> after = Thresholds(incidence, settings, potencies, {lost});
      const auto& ends = incidence.edges[static_cast<size_t>(lost)];
      for (size_t edge = 0; edge < after.size(); ++edge) {
        if (static_cast<int32_t>(edge) == lost) continue;
        const auto& [a, b] = incidence.edges[edge];
        const bool touches = a == ends[0] || a == ends[1] || b == ends[0] || b == ends[1];
        if (touches) {
          ASSERT_LT(after[edge], whole[edge]);
        } else {
          ASSERT_EQ(after[edge], whole[edge]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace cleave
