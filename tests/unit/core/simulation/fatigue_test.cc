#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/simulation/fracture_run.h"

namespace cleave {
namespace {

constexpr double kFar = 1e6;
constexpr double kStrength = 1e5;  // Pa

TetMesh Bar() { return KuhnBox({4, 2, 2}, {2, 1, 1}); }

// Held so that stress is the same everywhere, without inertia; a cycle takes a second.
Scene SlowBar(int steps_per_cycle) {
  Scene scene = TightScene(1e6, 0.3, 1e-6, 1.0 / steps_per_cycle);
  scene.materials[0].tensile_strength = kStrength;
  AddSymmetryPlanes(scene);
  AddBoxSet(scene, "x1", {2 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  AddMotion(scene, "x1", {true, false, false});
  return scene;
}

// Pulled to an elongation (m) and let go, again and again, below its strength.
Scene CycledBar(int steps_per_cycle) {
  Scene scene = SlowBar(steps_per_cycle);
  auto& keyframes = scene.motions.back().keyframes;
  for (int cycle = 0; cycle < 100; ++cycle) {
    keyframes.push_back({static_cast<double>(cycle), {0, 0, 0}, 0});
    keyframes.push_back({cycle + 0.5, {0.14, 0, 0}, 0});
  }
  scene.materials[0].fatigue = Fatigue{kStrength, -0.2, std::nullopt, 1};
  return scene;
}

// The cycle in which the bar breaks, from 1; 0 for none of 60. `peak` is the largest load, Pa.
int BreakingCycle(const Scene& scene, double& peak) {
  auto simulation = *Simulation::Create(scene, Bar(), {});
  const StopFlag stop;
  while (simulation->time() < 60) {
    const auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) return -1;
    if (report->broken_edges > 0) return static_cast<int>(std::ceil(simulation->time()));
    peak = std::max(peak, report->motion_forces.back()[0]);
  }
  return 0;
}

TEST(FatiguedBar, BreaksBelowItsStrengthAfterTheCyclesOfItsLifeForAnyTimeStep) {
  double peak = 0;
  const int coarse = BreakingCycle(CycledBar(2), peak);
  ASSERT_LT(peak, 0.8 * kStrength);
  // Smith, Watson and Topper's amplitude of a pulsating load, and Basquin's life.
  const double life = 0.5 * std::pow(peak / std::sqrt(2.0) / (kStrength), -1 / 0.2);
  ASSERT_GT(life, 20);
  // The last half cycle counts once it is over, and the next step breaks.
  EXPECT_NEAR(coarse, std::ceil(life), 1);
  EXPECT_NEAR(BreakingCycle(CycledBar(6), peak), coarse, 1);
}

TEST(FatiguedBar, LastsWithoutFatigueAndBelowTheEnduranceLimit) {
  double peak = 0;
  Scene scene = CycledBar(2);
  scene.materials[0].fatigue->endurance_limit = 0.6 * kStrength;
  EXPECT_EQ(BreakingCycle(scene, peak), 0);
  scene.materials[0].fatigue.reset();
  EXPECT_EQ(BreakingCycle(scene, peak), 0);
}

// Life goes by the share of the compressive strength, as it does by that of the tensile one.
TEST(FatiguedBar, PressedAgainAndAgainBreaksOnlyWhereItHasACompressiveStrength) {
  for (const auto aggregation : {StressAggregation::kMean, StressAggregation::kMax}) {
    Scene scene = CycledBar(2);
    scene.fracture.aggregation = aggregation;
    for (Keyframe& keyframe : scene.motions.back().keyframes) keyframe.translation[0] *= -0.95;
    double peak = 0;
    EXPECT_EQ(BreakingCycle(scene, peak), 0);
    scene.materials[0].compressive_strength = kStrength;
    const int pressed = BreakingCycle(scene, peak);
    EXPECT_GT(pressed, 10);
    scene.materials[0].compressive_strength = 1.25 * kStrength;
    const int longer = BreakingCycle(scene, peak);
    EXPECT_NEAR(static_cast<double>(longer) / pressed, std::pow(1.25, 1 / 0.2), 0.3);
  }
}

TEST(FatiguedBar, PulledOnceItHasTheSameStrength) {
  uint64_t frames[2] = {0, 0};
  for (const bool tires : {false, true}) {
    Scene scene = SlowBar(1);
    scene.motions.back().keyframes = {{0, {0, 0, 0}, 0}, {100, {0.3, 0, 0}, 0}};
    if (tires) scene.materials[0].fatigue = CycledBar(2).materials[0].fatigue;
    auto simulation = *Simulation::Create(scene, Bar(), {});
    const StopFlag stop;
    while (simulation->broken_edges().empty() && simulation->frame() < 100)
      ASSERT_TRUE(simulation->Advance(stop).ok());
    frames[tires ? 1 : 0] = static_cast<uint64_t>(simulation->frame());
    EXPECT_LT(simulation->frame(), 100);
  }
  EXPECT_EQ(frames[0], frames[1]);
}

Scene TiringScene() {
  Scene scene = BreakingScene();
  scene.materials[0].fatigue = Fatigue{3e4, -0.1, std::nullopt, 1};
  return scene;
}

TEST(Fatigue, ARestoredRunGoesOnWithTheSameBitsForAnyNumberOfThreads) {
  Simulation::Options one_thread;
  one_thread.threads = 1;
  auto whole = *Simulation::Create(TiringScene(), BreakingMesh(), {});
  const StopFlag stop;
  for (int frame = 0; frame < 5; ++frame) ASSERT_TRUE(whole->Advance(stop).ok());
  auto restored = *Simulation::Create(TiringScene(), BreakingMesh(), one_thread);
  ASSERT_TRUE(restored->Restore(whole->Save()).ok());
  EXPECT_EQ(restored->state_hash(), whole->state_hash());
  for (int frame = 0; frame < 4; ++frame) {
    ASSERT_TRUE(whole->Advance(stop).ok());
    ASSERT_TRUE(restored->Advance(stop).ok());
    EXPECT_EQ(restored->state_hash(), whole->state_hash());
  }
}

// Cancelled or halved steps leave no cycles behind: a frame that is tried again is the same frame.
TEST(Fatigue, ACancelledFrameLeavesNoTrace) {
  auto simulation = *Simulation::Create(TiringScene(), BreakingMesh(), {});
  StopFlag stop;
  for (int frame = 0; frame < 5; ++frame) ASSERT_TRUE(simulation->Advance(stop).ok());
  const uint64_t hash = simulation->state_hash();
  StopFlag stopped;
  stopped.Request();
  EXPECT_FALSE(simulation->Advance(stopped).ok());
  EXPECT_EQ(simulation->state_hash(), hash);
}

}  // namespace
}  // namespace cleave
