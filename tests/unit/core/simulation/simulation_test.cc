#include "core/simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tests/unit/core/simulation/fracture_run.h"
#include "tests/unit/core/simulation/run_frames.h"

namespace cleave {
namespace {

TEST(Simulation, ThreadsDoNotChangeABit) {
  auto one = MustCreate(BreakingScene(), BreakingMesh(), 1);
  auto two = MustCreate(BreakingScene(), BreakingMesh(), 2);
  EXPECT_EQ(one->state_hash(), two->state_hash());
  FrameReport last;
  for (int frame = 0; frame < 8; ++frame) {
    last = MustAdvance(*one);
    const FrameReport other = MustAdvance(*two);
    ASSERT_EQ(one->state_hash(), two->state_hash()) << "frame " << frame;
    EXPECT_EQ(last.linear_iterations, other.linear_iterations);
    EXPECT_EQ(last.motion_forces, other.motion_forces);
    EXPECT_EQ(last.external_work, other.external_work);
  }
  EXPECT_GT(last.broken_edges, 0);
  EXPECT_EQ(one->positions(), two->positions());
}

TEST(Simulation, OfADampedSceneNeitherThreadsNorARestoreChangeABit) {
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Scene scene = BreakingScene();
    scene.damping = Damping{1, 0.002};
    scene.quality.precision = precision;
    auto one = MustCreate(scene, BreakingMesh(), 1);
    auto two = MustCreate(scene, BreakingMesh(), 2);
    auto restored = MustCreate(scene, BreakingMesh(), 1);
    FrameReport last;
    for (int frame = 0; frame < 8; ++frame) {
      last = MustAdvance(*one);
      MustAdvance(*two);
      ASSERT_EQ(one->state_hash(), two->state_hash()) << "frame " << frame;
      if (frame == 5) ASSERT_TRUE(restored->Restore(one->Save()).ok());
      if (frame <= 5) continue;
      EXPECT_EQ(MustAdvance(*restored).damping_dissipation, last.damping_dissipation);
      EXPECT_EQ(restored->state_hash(), one->state_hash());
    }
    EXPECT_GT(last.broken_edges, 0);
    EXPECT_GT(last.damping_dissipation, 0);
    // What is damped is another run.
    scene.damping.reset();
    EXPECT_FALSE(MustCreate(scene, BreakingMesh())->Restore(one->Save()).ok());
  }
}

TEST(Simulation, ARestoredRunGoesOnWithTheSameBits) {
  auto whole = MustCreate(BreakingScene(), BreakingMesh());
  std::string saved;
  for (int frame = 0; frame < 8; ++frame) {
    MustAdvance(*whole);
    if (frame == 5) saved = whole->Save();
  }
  ASSERT_FALSE(whole->broken_edges().empty());
  auto restored = MustCreate(BreakingScene(), BreakingMesh());
  // Restoring replaces whatever the run has come to.
  MustAdvance(*restored);
  ASSERT_TRUE(restored->Restore(saved).ok());
  EXPECT_EQ(restored->frame(), 6);
  EXPECT_EQ(restored->Save(), saved);
  FrameReport report;
  for (int frame = 6; frame < 8; ++frame) report = MustAdvance(*restored);
  EXPECT_EQ(restored->state_hash(), whole->state_hash());
  EXPECT_EQ(restored->broken_edges(), whole->broken_edges());
  EXPECT_EQ(restored->fragments(), whole->fragments());
  EXPECT_EQ(restored->positions(), whole->positions());
  EXPECT_EQ(report.broken_edges, static_cast<int64_t>(whole->broken_edges().size()));
}

TEST(Simulation, RefusesDamagedAndForeignStatesAndStaysAsItWas) {
  auto simulation = MustCreate(BreakingScene(), BreakingMesh());
  MustAdvance(*simulation);
  const std::string saved = simulation->Save();
  const uint64_t hash = simulation->state_hash();
  EXPECT_EQ(simulation->Restore("").code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(simulation->Restore(saved.substr(0, saved.size() / 2)).code(),
            absl::StatusCode::kDataLoss);
  for (size_t at = 0; at < saved.size(); at += 997) {
    std::string damaged = saved;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    EXPECT_EQ(simulation->Restore(damaged).code(), absl::StatusCode::kDataLoss) << at;
  }
  Scene other = BreakingScene();
  other.materials[0].density *= 2;
  EXPECT_EQ(simulation->Restore(MustCreate(other, BreakingMesh())->Save()).code(),
            absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(
      simulation->Restore(MustCreate(BreakingScene(), KuhnBox({18, 4, 4}, {4.5, 1, 1.001}))->Save())
          .code(),
      absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(simulation->state_hash(), hash);
  EXPECT_EQ(simulation->frame(), 1);
}

TEST(Simulation, ARunMayBeProlongedAndShownOtherwise) {
  Scene longer = BreakingScene();
  longer.timing.frame_count *= 2;
  longer.output.keyframe_interval = 3;
  longer.render_mesh = RenderMeshSource{MeshAsset{std::string(64, 'a')}, 1};
  auto simulation = MustCreate(BreakingScene(), BreakingMesh());
  MustAdvance(*simulation);
  EXPECT_TRUE(MustCreate(longer, BreakingMesh())->Restore(simulation->Save()).ok());
}

TEST(Simulation, CancellingRollsBackToTheLastWholeFrame) {
  auto simulation = MustCreate(BreakingScene(), BreakingMesh());
  for (int frame = 0; frame < 6; ++frame) MustAdvance(*simulation);
  const uint64_t hash = simulation->state_hash();
  StopFlag stop;
  stop.Request();
  EXPECT_EQ(simulation->Advance(stop).status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(simulation->state_hash(), hash);
  EXPECT_EQ(simulation->frame(), 6);
  stop.Clear();
  EXPECT_TRUE(simulation->Advance(stop).ok());
  EXPECT_EQ(simulation->frame(), 7);
}

TEST(Simulation, AStepThatCannotConvergeAbortsNamingANodeAndRollsBack) {
  Scene scene = BreakingScene();
  scene.timing.steps_per_frame = 2;
  scene.quality.newton_iterations = 1;
  scene.quality.max_step_halvings = 1;
  scene.quality.residual_tolerance = 1e-13;
  auto simulation = MustCreate(scene, BreakingMesh());
  const uint64_t hash = simulation->state_hash();
  const StopFlag stop;
  const absl::Status status = simulation->Advance(stop).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kAborted);
  EXPECT_NE(status.message().find("node "), absl::string_view::npos) << status;
  EXPECT_EQ(simulation->state_hash(), hash);
  EXPECT_EQ(simulation->frame(), 0);
}

TEST(Simulation, ReportsEnergiesThatAddUp) {
  auto simulation = MustCreate(BreakingScene(), BreakingMesh());
  double fracture_energy = 0;
  for (int frame = 0; frame < 10; ++frame) {
    const FrameReport report = MustAdvance(*simulation);
    EXPECT_EQ(report.frame, frame + 1);
    EXPECT_DOUBLE_EQ(report.time, 0.01 * (frame + 1));
    EXPECT_GE(report.fracture_energy, fracture_energy);
    fracture_energy = report.fracture_energy;
    // Backward Euler only ever loses energy beyond what breaking takes.
    EXPECT_LE(report.kinetic_energy + report.elastic_energy + report.fracture_energy,
              report.external_work * (1 + 1e-3));
    EXPECT_EQ(report.motion_forces.size(), 2u);
    EXPECT_GE(report.fragments, 1);
  }
  EXPECT_GT(fracture_energy, 0);
}

TEST(Simulation, MaterialsThatCannotBreakKeepNoFractureState) {
  Scene scene = BreakingScene();
  auto breaking = MustCreate(scene, BreakingMesh());
  scene.materials[0].tensile_strength.reset();
  auto elastic = MustCreate(scene, BreakingMesh());
  EXPECT_LT(elastic->Save().size(), breaking->Save().size());
  for (int frame = 0; frame < 8; ++frame) MustAdvance(*elastic);
  EXPECT_TRUE(elastic->broken_edges().empty());
  EXPECT_EQ(elastic->fragments(), 1);
}

}  // namespace
}  // namespace cleave
