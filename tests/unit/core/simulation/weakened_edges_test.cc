#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "core/mesh/incidence.h"
#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kFar = 1e6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TetMesh Bar() { return KuhnBox({8, 2, 2}, {4, 1, 1}); }

Scene PulledBar() {
  Scene scene = TightScene(1e5, 0.3, 10, 0.01);
  scene.quality.residual_tolerance = 1e-6;
  scene.quality.step_tolerance = 1e-4;
  scene.quality.linear_tolerance = 1e-4;
  scene.materials[0].tensile_strength = 3000;
  AddBoxSet(scene, "x0", {-kFar, -kFar, -kFar}, {1e-9, kFar, kFar});
  AddBoxSet(scene, "x1", {4 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  AddMotion(scene, "x0");
  AddMotion(scene, "x1").keyframes = {{0, {0, 0, 0}, 0}, {0.5, {0.5, 0, 0}, 0}};
  return scene;
}

// The first frame with a broken edge, of 100; the simulation stays there.
int64_t FirstBreak(Simulation& simulation) {
  const StopFlag stop;
  for (int64_t frame = 1; frame <= 100; ++frame) {
    const auto report = simulation.Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok() || report->broken_edges > 0) return frame;
  }
  return -1;
}

// Across the bar between its fifth and sixth cross-section of nodes.
const BoxSelector kSlice{{2.2, -kFar, -kFar}, {2.3, kFar, kFar}};

TEST(WeakenedEdges, AFactorOfZeroCutsBeforeTheFirstStep) {
  for (const bool breakable : {true, false}) {
    Scene scene = PulledBar();
    if (!breakable) scene.materials[0].tensile_strength.reset();
    scene.weakenings = {{kSlice, 0}};
    auto simulation = *Simulation::Create(scene, Bar(), {});
    EXPECT_EQ(simulation->fragments(), 2);
    const Incidence incidence = BuildIncidence(Bar());
    for (const int32_t edge : simulation->broken_edges()) {
      const auto [a, b] = incidence.edges[static_cast<size_t>(edge)];
      EXPECT_LE(Bar().rest_positions[static_cast<size_t>(a)][0], 2.3);
      EXPECT_GE(Bar().rest_positions[static_cast<size_t>(b)][0], 2.2);
    }
    // The halves are free of each other: pulling one does not move the other.
    const StopFlag stop;
    for (int frame = 0; frame < 10; ++frame) ASSERT_TRUE(simulation->Advance(stop).ok());
    EXPECT_EQ(simulation->positions()[9], Bar().rest_positions[9]);
  }
}

TEST(WeakenedEdges, WeakOnesBreakFirstAndSoonerAndStrongOnesNever) {
  const Scene plain = PulledBar();
  const int64_t usual = FirstBreak(**Simulation::Create(plain, Bar(), {}));
  ASSERT_GT(usual, 0);
  Scene weak = plain;
  weak.weakenings = {{kSlice, 0.3}};
  auto simulation = *Simulation::Create(weak, Bar(), {});
  EXPECT_LT(FirstBreak(*simulation), usual);
  const Incidence incidence = BuildIncidence(Bar());
  for (const int32_t edge : simulation->broken_edges()) {
    const auto [a, b] = incidence.edges[static_cast<size_t>(edge)];
    EXPECT_EQ(Bar().rest_positions[static_cast<size_t>(a)][0], 2);
    EXPECT_EQ(Bar().rest_positions[static_cast<size_t>(b)][0], 2.5);
  }
  Scene strong = plain;
  strong.weakenings = {{BoxSelector{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}}, kInfinity}};
  EXPECT_EQ(FirstBreak(**Simulation::Create(strong, Bar(), {})), -1);
}

TEST(WeakenedEdges, AreChosenBySpheresAndNodeSetsAndTheLastCounts) {
  Scene scene = PulledBar();
  AddBoxSet(scene, "head", {-kFar, -kFar, -kFar}, {0.6, kFar, kFar});
  scene.weakenings = {{EdgesOfNodes{"head"}, 0}};
  const auto by_nodes = *Simulation::Create(scene, Bar(), {});
  // Two cross-sections of nine nodes come apart; the rest is one piece.
  EXPECT_FALSE(by_nodes->broken_edges().empty());
  scene.weakenings.push_back({EdgesOfNodes{"head"}, 1});
  EXPECT_TRUE((*Simulation::Create(scene, Bar(), {}))->broken_edges().empty());
  scene.weakenings = {{SphereSelector{{2, 0.5, 0.5}, 0.01}, 0}};
  const auto by_sphere = *Simulation::Create(scene, Bar(), {});
  // Every edge of the one node that the sphere holds; then those that only its tets held.
  const Incidence incidence = BuildIncidence(Bar());
  const int32_t node = (4 * 3 + 1) * 3 + 1;
  const auto spokes = incidence.node_edges[node];
  EXPECT_TRUE(std::includes(by_sphere->broken_edges().begin(), by_sphere->broken_edges().end(),
                            spokes.begin(), spokes.end()));
  EXPECT_LT(by_sphere->broken_edges().size(), 2 * spokes.size());
  EXPECT_EQ(by_sphere->fragments(), 2);
}

TEST(StressAggregation, TheLargestBreaksNoLaterThanTheMean) {
  Scene scene = PulledBar();
  scene.motions[1].keyframes.back().time = 2;
  const int64_t mean = FirstBreak(**Simulation::Create(scene, Bar(), {}));
  scene.fracture.aggregation = StressAggregation::kMax;
  const int64_t max = FirstBreak(**Simulation::Create(scene, Bar(), {}));
  EXPECT_GT(max, 0);
  EXPECT_LT(max, mean);
}

}  // namespace
}  // namespace cleave
