#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/damage/components.h"
#include "core/mesh/incidence.h"
#include "core/model/build_model.h"
#include "core/simulation/simulation.h"
#include "core/solver/stepper.h"
#include "tests/unit/core/simulation/fracture_run.h"

namespace cleave {
namespace {

Scene StrandScene(Reformulation reformulation = Reformulation::kUniform) {
  Scene scene = BreakingScene();
  scene.materials[0].strands = Strands{0.2, 1.6};
  scene.fracture.reformulation = reformulation;
  return scene;
}

constexpr Reformulation kBoth[] = {Reformulation::kUniform, Reformulation::kEdgeProjected};

std::unique_ptr<Simulation> Start(const Scene& scene, int threads = 1) {
  Simulation::Options options;
  options.threads = threads;
  return *Simulation::Create(scene, BreakingMesh(), options);
}

// A bar pulled to three times its length, without inertia to speak of. Edges along it are stronger,
// so that those aslant tear the tets.
TetMesh BarMesh() { return KuhnBox({4, 2, 2}, {2, 1, 1}); }
Scene PulledBar(Reformulation reformulation) {
  Scene scene = TightScene(1e6, 0.3, 1, 0.02);
  scene.quality = Quality{};
  scene.quality.newton_iterations = 20;
  scene.materials[0].tensile_strength = 2e4;
  scene.materials[0].fibres.push_back({0, ConstantDirection{{1, 0, 0}}, 3});
  scene.fracture.reformulation = reformulation;
  AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(scene, "right", {2 - 1e-9, -1, -1}, {3, 2, 2});
  AddMotion(scene, "left");
  AddMotion(scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {4, {4, 0, 0}, 0}};
  return scene;
}

// The frame in which the grips come apart, the largest force on one until then, N, and the least
// from that on.
struct Tear {
  int64_t frame = 201;  // never
  double peak = 0, least = 0;
};
Tear TearApart(const Scene& scene) {
  const TetMesh mesh = BarMesh();
  const Incidence incidence = BuildIncidence(mesh);
  const auto simulation = *Simulation::Create(scene, mesh, {});
  const StopFlag stop;
  Tear tear;
  while (simulation->frame() < 200) {
    const auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) break;
    std::vector<uint8_t> broken(incidence.edges.size(), 0);
    for (const int32_t edge : simulation->broken_edges()) broken[static_cast<size_t>(edge)] = 1;
    std::vector<int32_t> pieces;
    LabelComponents(incidence, broken, pieces);
    bool joined = false;
    for (size_t a = 0; a < pieces.size(); ++a) {
      for (size_t b = 0; b < pieces.size() && mesh.rest_positions[a][0] == 0; ++b)
        joined = joined || (mesh.rest_positions[b][0] == 2 && pieces[a] == pieces[b]);
    }
    if (!joined) {
      tear.frame = simulation->frame();
      break;
    }
    const double force = report->motion_forces.back()[0];
    tear.least = force > tear.peak ? force : std::min(tear.least, force);
    tear.peak = std::max(tear.peak, force);
  }
  return tear;
}

TEST(Strands, HoldATornBodyWithLittleForceUntilTheirLimit) {
  for (const Reformulation reformulation : kBoth) {
    Scene scene = PulledBar(reformulation);
    const Tear without = TearApart(scene);
    scene.materials[0].strands = Strands{0.1, 1.2};
    const Tear with = TearApart(scene);
    scene.materials[0].strands->stretch_limit = 1.5;
    const Tear longer = TearApart(scene);
    ASSERT_LT(without.frame, 100);
    EXPECT_GT(with.frame, without.frame);
    EXPECT_GT(longer.frame, with.frame);
    EXPECT_LT(with.least, 0.5 * with.peak);
  }
}

TEST(Strands, EnergyNeverRisesWhereTheyFormOrTear) {
  for (const Reformulation reformulation : kBoth) {
    Scene scene = StrandScene(reformulation);
    scene.quality.residual_tolerance = 1e-7;
    auto simulation = Start(scene);
    const StopFlag stop;
    double fracture_energy = 0, largest = 0;
    int64_t torn_frames = 0;
    for (int frame = 0; frame < 30; ++frame) {
      const auto report = simulation->Advance(stop);
      ASSERT_TRUE(report.ok()) << report.status();
      EXPECT_GE(report->fracture_energy, fracture_energy);
      torn_frames += report->fracture_energy > fracture_energy ? 1 : 0;
      fracture_energy = report->fracture_energy;
      const double held = report->kinetic_energy + report->elastic_energy;
      const double taken = report->fracture_energy + report->integration_dissipation;
      largest = std::max({largest, std::abs(report->external_work), held, taken});
      EXPECT_NEAR(report->external_work, held + taken, 1e-4 * largest) << frame;
    }
    EXPECT_GT(torn_frames, 3);
  }
}

TEST(Strands, ThreadsDoNotChangeABit) {
  auto one = Start(StrandScene(), 1), four = Start(StrandScene(), 4);
  const StopFlag stop;
  for (int frame = 0; frame < 12; ++frame) {
    ASSERT_TRUE(one->Advance(stop).ok());
    ASSERT_TRUE(four->Advance(stop).ok());
    ASSERT_EQ(one->state_hash(), four->state_hash()) << frame;
  }
  EXPECT_FALSE(one->broken_edges().empty());
}

TEST(Strands, ARestoredRunGoesOnWithTheSameBits) {
  for (const Reformulation reformulation : kBoth) {
    auto whole = Start(StrandScene(reformulation));
    const StopFlag stop;
    for (int frame = 0; frame < 12; ++frame) ASSERT_TRUE(whole->Advance(stop).ok());
    ASSERT_FALSE(whole->broken_edges().empty());
    auto restored = Start(StrandScene(reformulation));
    ASSERT_TRUE(restored->Restore(whole->Save()).ok());
    for (int frame = 0; frame < 4; ++frame) {
      EXPECT_EQ(restored->state_hash(), whole->state_hash());
      const auto expected = whole->Advance(stop), got = restored->Advance(stop);
      ASSERT_TRUE(expected.ok() && got.ok());
      EXPECT_EQ(expected->elastic_energy, got->elastic_energy);
    }
  }
}

TEST(Strands, ALawThatNoTetHasChangesNoPosition) {
  Scene with = BreakingScene();
  with.materials.push_back(with.materials[0]);
  Scene without = with;
  with.materials[0].strands = Strands{0.2, 1.6};  // the later material has every tet
  auto a = Start(with), b = Start(without);
  const StopFlag stop;
  for (int frame = 0; frame < 8; ++frame) {
    ASSERT_TRUE(a->Advance(stop).ok());
    ASSERT_TRUE(b->Advance(stop).ok());
    ASSERT_EQ(a->positions(), b->positions());
    ASSERT_EQ(a->broken_edges(), b->broken_edges());
  }
  EXPECT_FALSE(a->broken_edges().empty());
}

TEST(Strands, BearNoLoadsFromOutside) {
  const Scene scene = StrandScene();
  const TetMesh mesh = BreakingMesh();
  const Model model = *BuildModel(scene, mesh);
  Stepper stepper(model);
  State state = InitialState(scene, mesh, model);
  const StopFlag stop;
  StepReport report;
  for (int step = 0; step < 12; ++step)
    ASSERT_TRUE(stepper.Step(0.01 * step, 0.01 * (step + 1), stop, state, report).ok());
  const EdgeFracture& fracture = stepper.breaking()->fracture();
  const auto bearing = stepper.breaking()->SolidFactors();
  int strands = 0;
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const bool is_strand = fracture.IsStrand(static_cast<int32_t>(tet));
    strands += is_strand ? 1 : 0;
    EXPECT_EQ(bearing[tet], is_strand ? 0 : fracture.damage_factors()[tet]);
  }
  EXPECT_GT(strands, 10);
}

}  // namespace
}  // namespace cleave
