// Ductile bodies that flow and do not break.

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

// Frames up to a time.
FrameReport MustAdvanceTo(double time, Simulation& simulation) {
  FrameReport report;
  while (simulation.time() < time - 1e-9) report = MustAdvance(simulation);
  return report;
}

class EveryLaw : public ::testing::TestWithParam<ElasticLaw> {};
INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw,
                         ::testing::Values(ElasticLaw::kStableNeoHookean,
                                           ElasticLaw::kInvertibleNeoHookean,
                                           ElasticLaw::kCorotatedLinear,
                                           ElasticLaw::kStVenantKirchhoff));

TEST_P(EveryLaw, BelowYieldADuctileBodyMovesBitForBitAsAnElasticOne) {
  Scene scene = TwistedBar();
  scene.materials[0].law = GetParam();
  scene.materials[0].plasticity.reset();
  const auto elastic = MustCreate(scene, TwistedBarMesh());
  scene.materials[0].plasticity = Plasticity{.yield_stress = 1e12};
  const auto ductile = MustCreate(scene, TwistedBarMesh());
  for (int frame = 0; frame < 6; ++frame) {
    const FrameReport expected = MustAdvance(*elastic);
    const FrameReport report = MustAdvance(*ductile);
    ASSERT_EQ(ductile->positions(), elastic->positions()) << frame;
    EXPECT_EQ(report.elastic_energy, expected.elastic_energy);
    EXPECT_EQ(report.plastic_work, 0);
  }
}

// Of the pulled bar at rest, with the stretch that the report's force belongs to.
double TrueStress(const FrameReport& report, double stretch) {
  return report.motion_forces.back()[0] * stretch;
}

TEST_P(EveryLaw, APulledBarStaysOnTheYieldSurfaceAndKeepsItsSet) {
  Scene scene = PulledBar({{0, 0}, {0.5, 0.05}, {0.6, 0.05}, {1, 0.045}});
  scene.materials[0].law = GetParam();
  scene.materials[0].plasticity = Plasticity{.yield_stress = 1e4, .hardening = 5e4};
  const auto bar = MustCreate(scene, PulledBarMesh());
  const FrameReport held = MustAdvanceTo(0.6, *bar);
  const double strain = bar->plastic_strains()[0];
  for (const double other : bar->plastic_strains()) EXPECT_NEAR(other, strain, 1e-6);
  // Kirchhoff stress of a bar is its force over area at rest, times its stretch.
  EXPECT_NEAR(TrueStress(held, 1.05), 1e4 + 5e4 * strain, 2e-3 * 1e4);
  EXPECT_NEAR(strain, std::log(1.05) - (1e4 + 5e4 * strain) / 1e6, 5e-4);
  // Unloading is elastic: stress falls by Young's modulus times the logarithmic strain given back,
  // up to twice the square of the elastic strain, 1.2 %, by which St. Venant and Kirchhoff's law
  // differs.
  const FrameReport unloaded = MustAdvanceTo(1, *bar);
  EXPECT_EQ(bar->plastic_strains()[0], strain);
  EXPECT_NEAR(TrueStress(unloaded, 1.045), TrueStress(held, 1.05) - 1e6 * std::log(1.05 / 1.045),
              2 * 1e6 * 0.012 * 0.012);
}

TEST_P(EveryLaw, ALongStepEndsInEquilibriumOnTheYieldSurface) {
  // Four steps of two and a half yield strains each.
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Scene scene = PulledBar({{0, 0}, {0.5, 0.1}});
    scene.timing.frames_per_second = 8;
    scene.quality.precision = precision;
    scene.materials[0].law = GetParam();
    scene.materials[0].plasticity = Plasticity{.yield_stress = 1e4, .hardening = 5e4};
    if (precision == Precision::kFloat) scene.quality.residual_tolerance = 1e-5;
    const double tolerance = precision == Precision::kFloat ? 1e-3 : 1e-6;
    const auto bar = MustCreate(scene, PulledBarMesh());
    for (int frame = 1; frame <= 4; ++frame) {
      const FrameReport report = MustAdvance(*bar);
      const double yield = 1e4 + 5e4 * bar->plastic_strains()[0];
      EXPECT_NEAR(TrueStress(report, 1 + 0.025 * frame), yield, tolerance * yield) << frame;
      // Nothing presses from the sides, so the volume is that of the axial stress alone; of the
      // laws only that of St. Venant and Kirchhoff strays from it by several elastic strains.
      const Vec3 corner = bar->positions().back();
      const double mean = yield / 3, modulus = 1e6 / (3 * (1 - 2 * 0.3));
      EXPECT_NEAR(std::log(corner[0] * corner[1] * corner[2]), mean / modulus,
                  0.07 * mean / modulus)
          << frame;
    }
  }
}

TEST(Plasticity, ABarThatIsLetGoKeepsItsSet) {
  Scene scene = PulledBar({{0, 0}, {0.5, 0.05}, {0.51, 0.0389}, {1, 0.0389}});
  scene.materials[0].plasticity = Plasticity{.yield_stress = 1e4};
  const auto bar = MustCreate(scene, PulledBarMesh());
  const FrameReport report = MustAdvanceTo(1, *bar);
  // ln(1.0389) = ln(1.05) - 1e4 / 1e6 to a tenth of a percent: no force holds it there.
  EXPECT_NEAR(report.motion_forces.back()[0], 0, 0.08 * 1e4);
  EXPECT_GT(bar->plastic_strains()[0], 0.035);
}

TEST(Plasticity, FlowKeepsVolume) {
  Scene scene = PulledBar({{0, 0}, {0.5, 1}, {0.6, 1}});
  scene.materials[0].plasticity = Plasticity{.yield_stress = 1e4};
  const auto bar = MustCreate(scene, PulledBarMesh());
  MustAdvanceTo(0.6, *bar);
  const Vec3 corner = bar->positions().back();
  // Only the elastic strain, of a hundredth, changes volume, by 1 - 2 nu of it.
  EXPECT_NEAR(corner[0] * corner[1] * corner[2], 1 + (1 - 2 * 0.3) * 0.01, 1e-3);
  EXPECT_NEAR(corner[1], std::sqrt(0.5), 2e-3);
}

TEST(Plasticity, ViscosityMakesQuickPullingStronger) {
  double peak[3];
  double relaxed = 0;
  for (const int k : {0, 1, 2}) {
    const double seconds = k == 0 ? 0.1 : 1;
    Scene scene = PulledBar({{0, 0}, {seconds, 0.05}, {seconds + 2, 0.05}});
    scene.materials[0].plasticity = Plasticity{.yield_stress = 1e4};
    if (k < 2) scene.materials[0].plasticity->flow_rate = 10;
    const auto bar = MustCreate(scene, PulledBarMesh());
    peak[k] = TrueStress(MustAdvanceTo(seconds, *bar), 1.05);
    if (k == 0) relaxed = TrueStress(MustAdvanceTo(seconds + 2, *bar), 1.05);
  }
  EXPECT_GT(peak[0], 1.5 * peak[1]);
  // Overstress settles where a second's flow keeps up with pulling: E rate / flow_rate.
  EXPECT_NEAR(peak[1], 1e4 + 1e6 * 0.05 / 10, 0.1 * 1e4);
  EXPECT_NEAR(peak[2], 1e4, 0.06 * 1e4);
  EXPECT_NEAR(relaxed, 1e4, 1e-3 * 1e4);
}

TEST(Plasticity, OnlyTetsOfDuctileMaterialsFlow) {
  Scene scene = TwistedBar();
  TetMesh mesh = TwistedBarMesh();
  mesh.tet_regions.assign(mesh.tets.size(), 0);
  for (size_t tet = 0; tet < mesh.tets.size() / 2; ++tet) mesh.tet_regions[tet] = 1;
  scene.materials.push_back(scene.materials[0]);
  scene.materials[0].regions = {"0"};
  scene.materials[1].regions = {"1"};
  scene.materials[1].plasticity.reset();
  const auto bar = MustCreate(scene, mesh);
  for (int frame = 0; frame < 10; ++frame) MustAdvance(*bar);
  const std::vector<double> strains = bar->plastic_strains();
  ASSERT_EQ(strains.size(), mesh.tets.size());
  double most = 0;
  for (size_t tet = 0; tet < strains.size(); ++tet) {
    if (mesh.tet_regions[tet] == 1) {
      EXPECT_EQ(strains[tet], 0);
    } else {
      most = std::max(most, strains[tet]);
    }
  }
  EXPECT_GT(most, 0.01);
}

TEST(Plasticity, AnElasticBodyHasNoPlasticStrains) {
  Scene scene = TwistedBar();
  scene.materials[0].plasticity.reset();
  EXPECT_TRUE(MustCreate(scene, TwistedBarMesh())->plastic_strains().empty());
}

TEST(Plasticity, AnyThreadCountGivesTheSameBits) {
  std::vector<uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    const auto bar = MustCreate(TwistedBar(), TwistedBarMesh(), threads);
    for (int frame = 0; frame < 8; ++frame) MustAdvance(*bar);
    const std::vector<double> strains = bar->plastic_strains();
    EXPECT_GT(*std::max_element(strains.begin(), strains.end()), 0.01);
    hashes.push_back(bar->state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Plasticity, ASaveInTheMiddleOfFlowGoesOnAsIfNothingHadBeen) {
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Scene scene = TwistedBar();
    scene.quality.precision = precision;
    const auto first = MustCreate(scene, TwistedBarMesh());
    for (int frame = 0; frame < 6; ++frame) MustAdvance(*first);
    const std::string saved = first->Save();
    const double work = MustAdvance(*first).plastic_work;
    EXPECT_GT(work, 0);
    const auto second = MustCreate(scene, TwistedBarMesh());
    const uint64_t fresh = second->state_hash();
    EXPECT_NE(fresh, first->state_hash());
    ASSERT_TRUE(second->Restore(saved).ok());
    EXPECT_EQ(second->Save(), saved);
    EXPECT_EQ(MustAdvance(*second).plastic_work, work);
    EXPECT_EQ(second->state_hash(), first->state_hash());
    EXPECT_EQ(second->plastic_strains(), first->plastic_strains());
  }
}

TEST(Plasticity, AFrameThatFailsLeavesThePlasticStrainOfTheLast) {
  const auto bar = MustCreate(TwistedBar(), TwistedBarMesh());
  for (int frame = 0; frame < 6; ++frame) MustAdvance(*bar);
  const uint64_t before = bar->state_hash();
  StopFlag stop;
  stop.Request();
  EXPECT_FALSE(bar->Advance(stop).ok());
  EXPECT_EQ(bar->state_hash(), before);
}

TEST(Plasticity, FloatFlowsAsDoubleDoes) {
  Scene scene = TwistedBar();
  scene.quality.residual_tolerance = 1e-5;
  const auto in_double = MustCreate(scene, TwistedBarMesh());
  scene.quality.precision = Precision::kFloat;
  const auto in_float = MustCreate(scene, TwistedBarMesh());
  FrameReport expected, report;
  for (int frame = 0; frame < 8; ++frame) {
    expected = MustAdvance(*in_double);
    report = MustAdvance(*in_float);
  }
  EXPECT_NEAR(report.plastic_work, expected.plastic_work, 1e-3 * expected.plastic_work);
  const std::vector<double> strains = in_double->plastic_strains();
  const double most = *std::max_element(strains.begin(), strains.end());
  for (size_t tet = 0; tet < strains.size(); ++tet)
    EXPECT_NEAR(in_float->plastic_strains()[tet], strains[tet], 1e-3 * most);
}

TEST(Plasticity, HugeStrainsStayFinite) {
  for (const ElasticLaw law : {ElasticLaw::kStableNeoHookean, ElasticLaw::kInvertibleNeoHookean,
                               ElasticLaw::kCorotatedLinear}) {
    for (const double twist : {0.0, 60.0}) {
      Scene scene = TwistedBar();
      scene.quality = Quality{};
      scene.quality.newton_iterations = 50;
      scene.quality.max_step_halvings = 2;
      scene.materials[0].law = law;
      // To a hundred times its length, then crushed to a hundredth.
      scene.motions.back().keyframes = {
          {0, {0, 0, 0}, 0}, {0.1, {200, 0, 0}, twist}, {0.2, {-1.98, 0, 0}, 0}};
      const auto bar = MustCreate(scene, KuhnBox({4, 2, 2}, {2, 1, 1}));
      const StopFlag stop;
      double work = 0;
      for (int frame = 0; frame < 20; ++frame) {
        const auto report = bar->Advance(stop);
        if (!report.ok()) {
          // A named refusal is an end too.
          EXPECT_TRUE(absl::IsAborted(report.status())) << report.status();
          break;
        }
        EXPECT_TRUE(std::isfinite(report->elastic_energy));
        EXPECT_GE(report->plastic_work, work);
        work = report->plastic_work;
      }
      for (const Vec3& position : bar->positions())
        for (const double x : position) EXPECT_TRUE(std::isfinite(x));
      for (const double strain : bar->plastic_strains()) EXPECT_TRUE(std::isfinite(strain));
    }
  }
}

}  // namespace
}  // namespace cleave
