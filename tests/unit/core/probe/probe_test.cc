#include "core/probe/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

namespace cleave {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

MaterialProbe ProbeOf(std::optional<double> strength) {
  MaterialProbe probe;
  probe.material.youngs_modulus = 1e6;
  probe.material.poisson_ratio = 0.3;
  probe.material.density = 1000;
  probe.material.tensile_strength = strength;
  return probe;
}

MaterialProbe FibreProbe(double stiffness, double strength_ratio) {
  MaterialProbe probe = ProbeOf(1e4);
  FibreFamily family;
  family.stiffness = stiffness;
  family.strength_ratio = strength_ratio;
  family.direction = ConstantDirection{{0, 0, 2}};
  probe.material.fibres = {family};
  return probe;
}

ProbeReport ReportOf(const MaterialProbe& probe) { return *RunProbe(probe, StopFlag()); }

TEST(Probe, GivesUpWhereItIsAskedTo) {
  StopFlag stop;
  stop.Request();
  EXPECT_TRUE(absl::IsCancelled(RunProbe(ProbeOf(2e5), stop).status()));
}

TEST(Probe, EndsACurveWhereNominalStressReachesTheTensileStrength) {
  const ProbeReport report = ReportOf(ProbeOf(2e5));
  ASSERT_EQ(report.curves.size(), 1u);
  const StressStrainCurve& curve = report.curves[0];
  EXPECT_EQ(curve.direction, (Vec3{1, 0, 0}));
  EXPECT_EQ(curve.end, CurveEnd::kTensileStrength);
  ASSERT_EQ(curve.points.size(), 101u);
  EXPECT_EQ(curve.points[0].strain, 0);
  EXPECT_NEAR(curve.points.back().nominal_stress, 2e5, 1e-4);
  EXPECT_NEAR(curve.points.back().failure_ratio, 1, 1e-11);
  EXPECT_LT(curve.points[99].failure_ratio, 1);
  EXPECT_EQ(curve.worst_edge, curve.direction);
  EXPECT_NEAR(curve.youngs_modulus, 1e6, 1e-6);
  for (size_t k = 1; k < curve.points.size(); ++k) {
    const CurvePoint& point = curve.points[k];
    EXPECT_NEAR(point.strain, curve.points.back().strain * static_cast<double>(k) / 100, 1e-12);
    EXPECT_GT(point.true_stress, point.nominal_stress);
    EXPECT_GT(point.energy, curve.points[k - 1].energy);
  }
}

TEST(Probe, FindsFailureWhereverStrengthLies) {
  for (const double strength : {1e-6, 1.0, 1e3, 1e5, 6e5}) {
    const StressStrainCurve curve = ReportOf(ProbeOf(strength)).curves[0];
    EXPECT_EQ(curve.end, CurveEnd::kTensileStrength) << strength;
    EXPECT_NEAR(curve.points.back().nominal_stress, strength, 1e-9 * strength);
  }
}

TEST(Probe, LetsGoOfWhatDoesNotBreak) {
  for (const std::optional<double> strength : {std::optional<double>(), {kInf}, {1e8}}) {
    MaterialProbe probe = ProbeOf(strength);
    probe.largest_strain = 0.25;
    probe.samples = 10;
    const StressStrainCurve curve = ReportOf(probe).curves[0];
    EXPECT_EQ(curve.end, CurveEnd::kLargestStrain);
    EXPECT_EQ(curve.points.back().strain, 0.25);
  }
}

TEST(Probe, PullsTenTimesFartherWhatCanBreak) {
  EXPECT_EQ(ReportOf(ProbeOf(1e9)).curves[0].points.back().strain, 10);
  EXPECT_EQ(ReportOf(ProbeOf(std::nullopt)).curves[0].points.back().strain, 1);
}

TEST(Probe, BreaksAtOnceWithoutStrength) {
  const StressStrainCurve curve = ReportOf(ProbeOf(0.0)).curves[0];
  EXPECT_EQ(curve.end, CurveEnd::kTensileStrength);
  EXPECT_EQ(curve.points.size(), 1u);
}

TEST(Probe, PullsAlongAndAcrossFibresUnlessToldOtherwise) {
  const ProbeReport report = ReportOf(FibreProbe(3e6, 1));
  ASSERT_EQ(report.curves.size(), 2u);
  EXPECT_EQ(report.curves[0].direction, (Vec3{0, 0, 1}));
  EXPECT_EQ(report.curves[1].direction[2], 0);
  EXPECT_NEAR(report.curves[0].youngs_modulus, 4e6, 1e-4);
  EXPECT_NEAR(report.curves[1].youngs_modulus, 1.07239e6, 5);
}

TEST(Probe, BreaksTheMatrixWhileFibresCarryTheirShare) {
  MaterialProbe probe = FibreProbe(3e6, 1);
  const StressStrainCurve matrix = ReportOf(probe).curves[0];
  EXPECT_EQ(matrix.end, CurveEnd::kTensileStrength);
  // At 1 % strain, where the laws are nearly linear: the matrix carries a quarter.
  EXPECT_NEAR(matrix.points.back().nominal_stress, 4e4, 0.03 * 4e4);
  probe.stress = FractureStress::kTotal;
  const StressStrainCurve total = ReportOf(probe).curves[0];
  EXPECT_NEAR(total.points.back().nominal_stress, 1e4, 1e-6);
}

TEST(Probe, NamesTheStrengthOfFibresWhereItHolds) {
  const ProbeReport report = ReportOf(FibreProbe(0, 3));
  EXPECT_EQ(report.curves[0].end, CurveEnd::kDirectionalStrength);
  EXPECT_NEAR(report.curves[0].points.back().nominal_stress, 3e4, 1e-6);
  EXPECT_EQ(report.curves[1].end, CurveEnd::kTensileStrength);
  EXPECT_NEAR(report.curves[1].points.back().nominal_stress, 1e4, 1e-6);
}

MaterialProbe DuctileProbe() {
  MaterialProbe probe = ProbeOf(3e4);
  probe.material.plasticity = Plasticity{.yield_stress = 1e4, .hardening = 5e4};
  return probe;
}

TEST(Probe, LetsADuctileBarFlowUntilItHardensToItsStrength) {
  const StressStrainCurve curve = ReportOf(DuctileProbe()).curves[0];
  EXPECT_EQ(curve.end, CurveEnd::kTensileStrength);
  const CurvePoint& end = curve.points.back();
  // Edge stress is per area after flow, so nearly true stress; yield is in Kirchhoff stress. They
  // differ by the elastic strain, 3 %.
  EXPECT_NEAR(end.plastic_strain, (1.03 * 3e4 - 1e4) / 5e4, 0.003);
  EXPECT_NEAR(end.true_stress, 3e4, 0.03 * 3e4);
  EXPECT_LT(end.nominal_stress, 0.7 * end.true_stress);
  EXPECT_NEAR(end.volume_ratio, 1, 0.02);  // flow keeps it
  double work = 0;
  for (size_t k = 1; k < curve.points.size(); ++k) {
    const CurvePoint& point = curve.points[k];
    const CurvePoint& before = curve.points[k - 1];
    EXPECT_GE(point.plastic_strain, before.plastic_strain);
    // On the yield surface, or below it.
    const double kirchhoff = point.true_stress * point.volume_ratio;
    EXPECT_LT(kirchhoff, (1e4 + 5e4 * point.plastic_strain) * (1 + 1e-6));
    work += 0.5 * (point.nominal_stress + before.nominal_stress) * (point.strain - before.strain);
  }
  EXPECT_NEAR(end.energy, work, 0.005 * work);
}

TEST(Probe, EndsADuctileBarAtItsFailureStrain) {
  MaterialProbe probe = DuctileProbe();
  probe.material.plasticity->failure_strain = 0.1;
  const StressStrainCurve curve = ReportOf(probe).curves[0];
  EXPECT_EQ(curve.end, CurveEnd::kFailureStrain);
  EXPECT_NEAR(curve.points.back().plastic_strain, 0.1, 1e-9);
  EXPECT_NEAR(curve.points.back().failure_ratio, 1, 1e-9 / 0.1);
}

TEST(Probe, LetsAPerfectlyPlasticBarFlowOn) {
  MaterialProbe probe = DuctileProbe();
  probe.material.plasticity->hardening = 0;
  probe.largest_strain = 1;
  const StressStrainCurve curve = ReportOf(probe).curves[0];
  EXPECT_EQ(curve.end, CurveEnd::kLargestStrain);
  EXPECT_NEAR(curve.points.back().true_stress * curve.points.back().volume_ratio, 1e4, 1);
}

TEST(Probe, AnswersAGradientAfterFlow) {
  MaterialProbe probe = DuctileProbe();
  probe.deformation_gradients = {{1, 0.1, 0, 0, 1, 0, 0, 0, 1}, {1, 1e-3, 0, 0, 1, 0, 0, 0, 1}};
  const ProbeReport report = ReportOf(probe);
  EXPECT_GT(report.points[0].plastic_strain, 0.01);
  EXPECT_EQ(report.points[1].plastic_strain, 0);
}

TEST(Probe, PressesBarsUntilTheyAreCrushed) {
  MaterialProbe probe = ProbeOf(1e3);
  probe.material.compressive_strength = 5e4;
  probe.largest_strain = -0.5;
  const StressStrainCurve curve = ReportOf(probe).curves[0];
  EXPECT_EQ(curve.end, CurveEnd::kCompressiveStrength);
  EXPECT_NEAR(curve.points.back().nominal_stress, -5e4, 1e-6);
  EXPECT_LT(curve.points.back().strain, -0.04);
  probe.material.compressive_strength.reset();
  probe.largest_strain = -0.2;
  EXPECT_EQ(ReportOf(probe).curves[0].points.back().strain, -0.2);
}

TEST(Probe, TakesDirectionsThatDependOnThePlaceFromAPoint) {
  MaterialProbe probe = FibreProbe(3e6, 1);
  probe.material.fibres[0].direction = CylindricalDirection{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}};
  EXPECT_THAT(std::string(ValidateProbe(probe).ToStatus().message()),
              testing::HasSubstr("point: is missing; the direction of material.fibres[0] depends"));
  probe.point = Vec3{2, 0, 5};
  EXPECT_TRUE(ValidateProbe(probe).ok());
  EXPECT_NEAR(ReportOf(probe).curves[0].direction[1], 1, 1e-15);
  probe.fibre_directions = {{3, 0, 0}};
  EXPECT_EQ(ReportOf(probe).curves[0].direction, (Vec3{1, 0, 0}));
}

TEST(Probe, AnswersGradientsRowByRow) {
  MaterialProbe probe = ProbeOf(1e4);
  probe.deformation_gradients = {{1, 1e-3, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const ProbeReport report = ReportOf(probe);
  EXPECT_TRUE(report.curves.empty());
  ASSERT_EQ(report.points.size(), 2u);
  const double mu = 1e6 / 2.6;
  EXPECT_NEAR(report.points[0].stress[1], 1e-3 * mu, 1e-9 * mu);
  EXPECT_NEAR(report.points[0].energy, 0.5e-6 * mu, 1e-9 * mu);
  EXPECT_EQ(report.points[1].energy, 0);
  EXPECT_NEAR(report.points[1].tangent[9 * 1 + 3], mu, 1e-9 * mu);        // dP_xy / dF_yx
  EXPECT_NEAR(report.points[1].tangent[0], mu * 2 + 0.3e6 / 0.52, 1e-3);  // lambda + 2 mu
}

TEST(Probe, NamesEveryFaultAtOnce) {
  MaterialProbe probe = FibreProbe(3e6, 1);
  probe.material.poisson_ratio = 0.7;
  probe.material.fibres[0].direction = TetDirections{{{1, 0, 0}}};
  probe.deformation_gradients = {{1, 0, 0, 0, std::nan(""), 0, 0, 0, 1e9}};
  probe.pull_directions = {{0, 0, 0}};
  probe.largest_strain = 0;
  probe.samples = 0;
  std::vector<std::string> fields;
  const Faults faults = ValidateProbe(probe);
  for (const Fault& fault : faults.errors()) fields.push_back(fault.field);
  EXPECT_THAT(fields,
              testing::ElementsAre("material.poisson_ratio", "fibre_directions",
                                   "deformation_gradients[0][4]", "deformation_gradients[0][8]",
                                   "pull_directions[0]", "largest_strain", "samples"));
  probe.fibre_directions = {{1, 0, 0}, {0, 1, 0}};
  EXPECT_THAT(std::string(ValidateProbe(probe).ToStatus().message()),
              testing::HasSubstr("fibre_directions: has 2 directions; the material has 1"));
  probe.pull_directions.assign(17, {1, 0, 0});
  EXPECT_THAT(std::string(ValidateProbe(probe).ToStatus().message()),
              testing::HasSubstr("pull_directions: has 17 items; at most 16 are allowed"));
}

}  // namespace
}  // namespace cleave
