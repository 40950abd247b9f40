// Ductile bodies that break.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/simulation/ductile_bar.h"
#include "tests/unit/core/simulation/run_frames.h"

namespace cleave {
namespace {

double Largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

// Largest plastic strain in the frame in which the first edge breaks; negative where none does.
double StrainAtFirstBreak(const Scene& scene, const TetMesh& mesh) {
  const auto simulation = MustCreate(scene, mesh);
  const StopFlag stop;
  const double end = scene.motions.back().keyframes.back().time;
  while (simulation->time() < end) {
    const auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) break;
    if (report->broken_edges > 0) return Largest(simulation->plastic_strains());
  }
  return -1;
}

// Pulled to `elongation` in `steps`; yields at 1 kPa, a thousandth of Young's modulus.
Scene BreakingBar(double elongation, int steps, double hardening, double strength) {
  Scene scene = PulledBar({{0, 0}, {0.5, elongation}});
  scene.timing.frames_per_second = steps / 0.5;
  scene.materials[0].plasticity = Plasticity{.yield_stress = 1e3, .hardening = hardening};
  scene.materials[0].tensile_strength = strength;
  return scene;
}

TEST(DuctileFracture, AnAlignedBarBreaksWhereHardeningReachesItsStrengthHoweverLongItsSteps) {
  for (const StressAggregation aggregation : {StressAggregation::kMean, StressAggregation::kMax}) {
    for (const double strength : {1.5e3, 2e3}) {
      for (const int steps : {50, 200}) {
        Scene scene = BreakingBar(0.15, steps, 1e4, strength);
        scene.fracture.aggregation = aggregation;
        // (tau - sigma_Y) / H; found in the step that passes it.
        const double expected = (strength - 1e3) / 1e4;
        EXPECT_NEAR(StrainAtFirstBreak(scene, PulledBarMesh()), expected,
                    0.02 * expected + 0.15 / steps)
            << strength << " Pa in " << steps << " steps";
      }
    }
  }
}

TEST(DuctileFracture, WithoutHardeningNoStepIsSoLongThatStressBreaks) {
  // A step's strain is up to twenty times that at yield.
  for (const int steps : {50, 200}) {
    Scene scene = BreakingBar(1, steps, 0, 1.01e3);
    EXPECT_EQ(StrainAtFirstBreak(scene, PulledBarMesh()), -1) << steps;
    scene.materials[0].plasticity->failure_strain = 0.3;
    EXPECT_NEAR(StrainAtFirstBreak(scene, PulledBarMesh()), 0.3, 1.0 / steps) << steps;
  }
}

TEST(DuctileFracture, UpgradationRaisesDuctilityAndUnbreakableEdgesHaveNoEnd) {
  Scene scene = BreakingBar(1, 200, 0, 1.2e3);
  scene.materials[0].plasticity->failure_strain = 0.1;
  const double pure = StrainAtFirstBreak(scene, PulledBarMesh());
  scene.impurities = Impurities{.effect = ImpurityEffect::kUpgradation, .potency = 1};
  EXPECT_GT(StrainAtFirstBreak(scene, PulledBarMesh()), 1.5 * pure);
  scene.impurities.reset();
  scene.weakenings.push_back(
      {BoxSelector{{-9, -9, -9}, {9, 9, 9}}, std::numeric_limits<double>::infinity()});
  EXPECT_EQ(StrainAtFirstBreak(scene, PulledBarMesh()), -1);
}

TEST(DuctileFracture, BrittleAndDuctileStandInOneScene) {
  TetMesh mesh = KuhnBox({4, 1, 1}, {1, 0.25, 0.25});
  mesh.tet_regions.assign(mesh.tets.size(), 0);
  for (size_t tet = mesh.tets.size() / 2; tet < mesh.tets.size(); ++tet) mesh.tet_regions[tet] = 1;
  Scene scene = BreakingBar(0.2, 100, 0, 1.2e3);
  scene.materials[0].regions = {"0"};
  scene.materials[0].plasticity->failure_strain = 0.1;
  // Above what the mean stress reaches beside the half that does not flow.
  scene.materials[0].tensile_strength = 4e3;
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].regions = {"1"};
  scene.materials[1].plasticity.reset();
  // A brittle half that is stronger than the yield stress waits until the ductile one gives.
  scene.materials[1].tensile_strength = 3e3;
  EXPECT_GE(StrainAtFirstBreak(scene, mesh), 0.1 - 1e-3);
  // A weaker one breaks before anything flows.
  scene.materials[1].tensile_strength = 0.5e3;
  EXPECT_EQ(StrainAtFirstBreak(scene, mesh), 0);
}

// Pulled and twisted until it breaks.
Scene BreakingTwistedBar() {
  Scene scene = TwistedBar();
  // So strong that strain alone breaks it.
  scene.materials[0].tensile_strength = 1e6;
  scene.materials[0].plasticity->failure_strain = 0.25;
  return scene;
}

TEST(DuctileFracture, TheBudgetOfEnergyCloses) {
  const auto bar = MustCreate(BreakingTwistedBar(), TwistedBarMesh());
  const StopFlag stop;
  double largest = 0, work = 0;
  FrameReport report;
  for (int frame = 0; frame < 16; ++frame) {
    const auto next = bar->Advance(stop);
    ASSERT_TRUE(next.ok()) << next.status();
    report = *next;
    const double held = report.kinetic_energy + report.elastic_energy;
    const double taken =
        report.fracture_energy + report.plastic_work + report.integration_dissipation;
    largest = std::max({largest, std::abs(report.external_work), held, taken});
    EXPECT_NEAR(report.external_work, held + taken, 1e-4 * largest) << frame;
    EXPECT_GE(report.plastic_work, work);
    work = report.plastic_work;
  }
  EXPECT_GT(report.broken_edges, 0);
  EXPECT_GT(report.plastic_work, 0.1 * largest);
}

TEST(DuctileFracture, ASaveWhileItBreaksGoesOnAsIfNothingHadBeen) {
  const auto first = MustCreate(BreakingTwistedBar(), TwistedBarMesh());
  const StopFlag stop;
  std::string saved;
  for (int frame = 0; frame < 12; ++frame) {
    ASSERT_TRUE(first->Advance(stop).ok());
    if (saved.empty() && !first->broken_edges().empty()) {
      saved = first->Save();
      break;
    }
  }
  ASSERT_FALSE(saved.empty());
  const auto second = MustCreate(BreakingTwistedBar(), TwistedBarMesh());
  ASSERT_TRUE(second->Restore(saved).ok());
  for (int frame = 0; frame < 3; ++frame) {
    ASSERT_TRUE(first->Advance(stop).ok());
    ASSERT_TRUE(second->Advance(stop).ok());
    EXPECT_EQ(second->state_hash(), first->state_hash());
  }
}

TEST(DuctileFracture, AHalvedStepStartsFromThePlasticStrainBeforeIt) {
  // So few iterations that steps are halved, and what they flowed by is undone.
  Scene scene = BreakingTwistedBar();
  scene.quality.newton_iterations = 4;
  scene.quality.max_step_halvings = 12;
  const auto bar = MustCreate(scene, TwistedBarMesh());
  const StopFlag stop;
  int32_t halvings = 0;
  FrameReport report;
  for (int frame = 0; frame < 8; ++frame) {
    const auto next = bar->Advance(stop);
    ASSERT_TRUE(next.ok()) << next.status();
    report = *next;
    halvings += report.step_halvings;
  }
  EXPECT_GT(halvings, 0);
  const double held = report.kinetic_energy + report.elastic_energy;
  const double taken =
      report.fracture_energy + report.plastic_work + report.integration_dissipation;
  EXPECT_NEAR(report.external_work, held + taken, 1e-4 * report.external_work);
}

}  // namespace
}  // namespace cleave
