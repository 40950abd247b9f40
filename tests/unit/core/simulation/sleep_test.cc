#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/simulation/run_frames.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kGravity = 9.81;

// Blocks of rubber of 0.1 m, whose lower corners are at these places (m).
TetMesh Blocks(const std::vector<Vec3>& corners) {
  TetMesh mesh;
  for (const Vec3& corner : corners) AppendMesh(mesh, KuhnBox({2, 2, 2}, {0.1, 0.1, 0.1}, corner));
  return mesh;
}
constexpr size_t kBlockNodes = 27;

// On the ground, z = 0, in frames of a step of 5 ms.
Scene GroundScene() {
  Scene scene = TightScene(1e5, 0.3, 1000, 0.005);
  scene.quality.residual_tolerance = 1e-6;
  scene.quality.step_tolerance = 1e-6;
  scene.gravity = Vec3{0, 0, -kGravity};
  scene.colliders.emplace_back().shape = PlaneShape{};
  scene.colliders[0].friction = 0.5;
  scene.contact = Contact{5, 0.3};
  scene.sleep.emplace();
  return scene;
}

// Runs until so many pieces sleep; the frames that it took, or `most`.
int RunUntilAsleep(Simulation& simulation, int64_t pieces, int most) {
  for (int frame = 1; frame <= most; ++frame) {
    if (RunFrames(simulation, 1).sleeping_pieces == pieces) return frame;
  }
  return most;
}

double Height(const Simulation& simulation, size_t block) {
  double sum = 0;
  for (size_t node = block * kBlockNodes; node < (block + 1) * kBlockNodes; ++node)
    sum += simulation.positions()[node][2] / kBlockNodes;
  return sum;
}

TEST(Sleep, ABlockThatWasDroppedGoesToSleepAndThenRestsToTheBit) {
  auto simulation = *Simulation::Create(GroundScene(), Blocks({{0, 0, 0.05}}), {});
  EXPECT_LT(RunUntilAsleep(*simulation, 1, 600), 600);
  const std::vector<Vec3> positions = simulation->positions();
  const FrameReport report = RunFrames(*simulation, 50);
  EXPECT_EQ(simulation->positions(), positions);
  EXPECT_EQ(report.sleeping_pieces, 1);
  EXPECT_EQ(report.kinetic_energy, 0);
  EXPECT_EQ(report.newton_iterations, 0);
  EXPECT_EQ(report.linear_iterations, 0);
  EXPECT_GT(report.elastic_energy, 0);
  // It fell 5 cm; the budget counts what falling asleep took.
  EXPECT_NEAR(Budget(report, 0), 0, 1e-6 * report.external_work);
}

TEST(Sleep, ADampedBlockComesToRestSooner) {
  Scene scene = GroundScene();
  const TetMesh mesh = Blocks({{0, 0, 0.02}, {0.5, 0, 0}});
  const int without = RunUntilAsleep(**Simulation::Create(scene, mesh, {}), 2, 400);
  scene.damping = Damping{0, 0.005};
  auto simulation = *Simulation::Create(scene, mesh, {});
  EXPECT_LT(RunUntilAsleep(*simulation, 2, 400), without);
  const std::vector<Vec3> positions = simulation->positions();
  const FrameReport report = RunFrames(*simulation, 10);
  EXPECT_EQ(simulation->positions(), positions);
  EXPECT_EQ(report.kinetic_energy, 0);
  EXPECT_GT(report.damping_dissipation, 0);
  EXPECT_NEAR(Budget(report, 0), 0, 1e-6 * report.external_work);
}

TEST(Sleep, NothingSleepsUnlessTheSceneAsksForIt) {
  Scene scene = GroundScene();
  scene.sleep.reset();
  auto simulation = *Simulation::Create(scene, Blocks({{0, 0, 0}}), {});
  const FrameReport report = RunFrames(*simulation, 200);
  EXPECT_FALSE(report.sleeping_pieces.has_value());
  EXPECT_GT(report.kinetic_energy, 0);
}

TEST(Sleep, ABlockThatFallsOnASleepingOneWakesItBeforeItTouches) {
  // The upper one comes when the lower has long been asleep; the control never sleeps.
  const TetMesh mesh = Blocks({{0, 0, 0}, {0.02, 0.03, 2.5}});
  Scene scene = GroundScene();
  auto simulation = *Simulation::Create(scene, mesh, {});
  scene.sleep.reset();
  auto control = *Simulation::Create(scene, mesh, {});
  bool slept = false, woke = false;
  double lowest = 1;
  const StopFlag stop;
  for (int frame = 0; frame < 180; ++frame) {
    const FrameReport report = *simulation->Advance(stop);
    ASSERT_TRUE(control->Advance(stop).ok());
    slept = slept || report.sleeping_pieces == 1;
    woke = woke || (slept && report.sleeping_pieces == 0);
    // Together they weigh 2 kg.
    for (const size_t block : {0, 1})
      EXPECT_NEAR(Height(*simulation, block), Height(*control, block), 2e-3) << frame;
    lowest = std::min(lowest, Height(*simulation, 0));
  }
  EXPECT_TRUE(slept);
  EXPECT_TRUE(woke);
  EXPECT_LT(lowest, 0.045);  // it was pressed
}

TEST(Sleep, PiecesThatLieOnEachOtherSleepAndWakeTogether) {
  const TetMesh mesh = Blocks({{0, 0, 0}, {0, 0, 0.15}, {1, 0, 0}});
  auto simulation = *Simulation::Create(GroundScene(), mesh, {});
  // The one that lies alone sleeps first.
  const StopFlag stop;
  std::vector<int64_t> counts;
  for (int frame = 0; frame < 800 && (counts.empty() || counts.back() != 3); ++frame) {
    const int64_t count = *simulation->Advance(stop)->sleeping_pieces;
    if (counts.empty() || counts.back() != count) counts.push_back(count);
  }
  EXPECT_EQ(counts, (std::vector<int64_t>{0, 1, 3}));
}

TEST(Sleep, NothingSleepsAtTheTopOfItsFlight) {
  // Slower than the limit for a second and more, at a thousandth of gravity; without any, it rests.
  for (const double gravity : {0.0, 1e-3}) {
    Scene scene = GroundScene();
    scene.gravity = Vec3{0, 0, -gravity};
    scene.sleep->speed = 0.1;
    scene.initial_velocities.resize(1);
    scene.initial_velocities[0].velocity = {0, 0, gravity > 0 ? 2e-3 : 0};
    auto simulation = *Simulation::Create(scene, Blocks({{0, 0, 1}}), {});
    const FrameReport report = RunFrames(*simulation, 200);
    EXPECT_EQ(report.sleeping_pieces, gravity > 0 ? 0 : 1);
  }
}

// A block that hangs by its upper side until that lets go at 2 s.
Scene HangingScene() {
  Scene scene = GroundScene();
  scene.colliders.clear();
  AddBoxSet(scene, "top", {-1, -1, 0.1 - 1e-9}, {1, 1, 1});
  AddMotion(scene, "top").release = Release{.time = 2};
  return scene;
}

TEST(Sleep, APieceWakesWhenItsHingeLetsGo) {
  auto simulation = *Simulation::Create(HangingScene(), Blocks({{0, 0, 0}}), {});
  const int frames = RunUntilAsleep(*simulation, 1, 390);
  ASSERT_LT(frames, 390);
  FrameReport report = RunFrames(*simulation, 395 - frames);
  EXPECT_EQ(report.sleeping_pieces, 1);
  EXPECT_EQ(report.newton_iterations, 0);
  // The hinge bears its weight all the while.
  EXPECT_NEAR(report.motion_forces[0][2], kGravity, 0.05 * kGravity);
  const double held = Height(*simulation, 0);
  report = RunFrames(*simulation, 45);
  EXPECT_EQ(report.sleeping_pieces, 0);
  EXPECT_NEAR(held - Height(*simulation, 0), 0.5 * kGravity * 0.04, 0.02);
  EXPECT_NEAR(Budget(report, 0), 0, 1e-5);
}

TEST(Sleep, AMotionOrALoadThatChangesWakesWhatItActsOn) {
  for (const bool load : {false, true}) {
    Scene scene = HangingScene();
    scene.motions[0].release.reset();
    AddBoxSet(scene, "bottom", {-1, -1, -1}, {1, 1, 1e-9});
    if (load) {
      scene.loads.push_back({"bottom", PointForce{{0, 0, -1}}, {{2, 0}, {2.5, 1}}, {}});
    } else {
      scene.motions[0].keyframes = {{2, {0, 0, 0}, 0}, {2.5, {0, 0, 1e-4}, 0}};
    }
    auto simulation = *Simulation::Create(scene, Blocks({{0, 0, 0}}), {});
    EXPECT_EQ(RunFrames(*simulation, 400).sleeping_pieces, 1);
    EXPECT_EQ(RunFrames(*simulation, 1).sleeping_pieces, 0);
    // However slow that is, nothing sleeps while it goes on.
    EXPECT_EQ(RunFrames(*simulation, 98).sleeping_pieces, 0);
    EXPECT_EQ(RunFrames(*simulation, 200).sleeping_pieces, 1);
  }
}

TEST(Sleep, ACollidersComingWakesAndOneThatLiesStillSleepsToo) {
  Scene scene = GroundScene();
  Collider& crate = scene.colliders.emplace_back();
  // It lands after half a second.
  crate.shape = BoxShape{{0.05, 0.05, 1.5}, {0.12, 0.12, 0.05}};
  crate.friction = 0.3;
  crate.body.emplace().mass = 0.3;
  auto simulation = *Simulation::Create(scene, Blocks({{0, 0, 0}, {1, 0, 0}}), {});
  EXPECT_EQ(RunFrames(*simulation, 98).sleeping_pieces, 2);
  FrameReport report = RunFrames(*simulation, 10);
  EXPECT_EQ(report.sleeping_pieces, 1);
  EXPECT_LT(RunUntilAsleep(*simulation, 2, 1000), 1000);
  report = RunFrames(*simulation, 1);
  const ColliderPlace place = report.colliders[1];
  report = RunFrames(*simulation, 20);
  EXPECT_EQ(report.newton_iterations, 0);
  EXPECT_EQ(report.colliders[1].translation, place.translation);
  EXPECT_EQ(report.colliders[1].rotation, place.rotation);
}

// Blocks of which some sleep and one still flies, over ground that breaks the flying one.
Scene BreakingScene() {
  Scene scene = GroundScene();
  scene.quality = Quality{};
  scene.quality.newton_iterations = 30;
  scene.materials[0].tensile_strength = 1.5e3;
  return scene;
}
TetMesh BreakingBlocks() { return Blocks({{0, 0, 0}, {0.3, 0, 0}, {0.01, 0.02, 1.5}}); }

TEST(Sleep, PiecesThatBreakOffSleepInTheEndAndCloseTheBudget) {
  auto simulation = *Simulation::Create(BreakingScene(), BreakingBlocks(), {});
  FrameReport report = RunFrames(*simulation, 100);
  EXPECT_EQ(report.sleeping_pieces, 2);
  EXPECT_EQ(report.broken_edges, 0);
  report = RunFrames(*simulation, 60);
  EXPECT_GT(report.broken_edges, 0);
  EXPECT_GT(report.fragments, 3);
  EXPECT_GE(*report.sleeping_pieces, 1);
  EXPECT_NEAR(Budget(report, 0), 0, 1e-3 * report.external_work);
}

TEST(Sleep, GivesTheSameBitsOnAnyNumberOfThreads) {
  uint64_t hashes[2];
  for (int k = 0; k < 2; ++k) {
    auto simulation = *Simulation::Create(BreakingScene(), BreakingBlocks(), {1 + k});
    EXPECT_GT(RunFrames(*simulation, 130).sleeping_pieces, 0);
    hashes[k] = simulation->state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Sleep, GoesOnFromAStateSavedAsleepAsIfNothingHadHappened) {
  auto first = *Simulation::Create(BreakingScene(), BreakingBlocks(), {});
  EXPECT_EQ(RunFrames(*first, 100).sleeping_pieces, 2);
  auto second = *Simulation::Create(BreakingScene(), BreakingBlocks(), {});
  ASSERT_TRUE(second->Restore(first->Save()).ok());
  EXPECT_EQ(first->state_hash(), second->state_hash());
  const FrameReport a = RunFrames(*first, 40), b = RunFrames(*second, 40);
  EXPECT_EQ(first->state_hash(), second->state_hash());
  EXPECT_EQ(a.elastic_energy, b.elastic_energy);
  EXPECT_EQ(a.sleeping_pieces, b.sleeping_pieces);
  EXPECT_GT(a.broken_edges, 0);
}

}  // namespace
}  // namespace cleave
