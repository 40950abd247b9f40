#include "core/probe/pulled_bar.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>

namespace cleave {
namespace {

Material UnitMaterial(ElasticLaw law = ElasticLaw::kStableNeoHookean) {
  Material material;
  material.law = law;
  material.youngs_modulus = 1;
  material.poisson_ratio = 0.3;
  material.density = 1;
  return material;
}

Material WithFibres(double stiffness) {
  Material material = UnitMaterial();
  FibreFamily family;
  family.stiffness = stiffness;
  material.fibres = {family};
  return material;
}

TEST(PulledBar, FollowsTheClosedFormOfStableNeoHookean) {
  const MaterialPoint point(UnitMaterial(), {});
  const PulledBar bar(point, Eigen::Vector3d(1, 2, -2) / 3);
  const double mu = 1 / 2.6, bulk = mu + 0.3 / (1.3 * 0.4);
  PulledBar::State state = bar.AtRest();
  for (const double l : {1 + 1e-9, 1.001, 1.3, 2.0, 5.0}) {
    const std::optional<PulledBar::State> next = bar.Pull(l - 1, state);
    ASSERT_TRUE(next.has_value()) << l;
    state = *next;
    const double strain = l - 1;
    const double j = 1 + mu / bulk * strain / l;
    // mu (l - J/l^2), without the difference of large numbers.
    const double nominal = mu * strain * ((l * l + l + 1) / (l * l) - mu / bulk / (l * l * l));
    EXPECT_NEAR(state.nominal_stress, nominal, 1e-9 * nominal) << l;
    EXPECT_NEAR(state.volume_ratio, j, 1e-11) << l;
  }
}

TEST(PulledBar, HasTheNumbersOfTheMethodNoteAtTwiceItsLength) {
  const MaterialPoint point(UnitMaterial(), {});
  const PulledBar bar(point, Eigen::Vector3d::UnitX());
  const std::optional<PulledBar::State> state = bar.Pull(1, *bar.Pull(0.5, bar.AtRest()));
  ASSERT_TRUE(state.has_value());
  EXPECT_NEAR(state->nominal_stress, 0.653846, 5e-7);
  EXPECT_NEAR(1 + state->g(1, 1), 0.774597, 5e-7);
}

TEST(PulledBar, IsAsStiffAsTheMethodNoteSaysAlongAndAcrossFibres) {
  const Vec3 fibre{1, 1, 0};
  const MaterialPoint point(WithFibres(3), {&fibre, 1});
  const Eigen::Vector3d along = Eigen::Vector3d(1, 1, 0).normalized();
  EXPECT_NEAR(PulledBar(point, along).YoungsModulus(), 4, 1e-12);
  const PulledBar across(point, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(across.YoungsModulus(), 1.07239, 5e-6);
  EXPECT_NEAR(across.Pull(1e-7, across.AtRest())->nominal_stress / 1e-7, across.YoungsModulus(),
              1e-6);
}

TEST(PulledBar, LeavesNoStressOnItsSidesWhenFibresAreAskew) {
  const Vec3 fibre{1, 1, 0.3};
  for (const ElasticLaw law : {ElasticLaw::kStableNeoHookean, ElasticLaw::kInvertibleNeoHookean,
                               ElasticLaw::kCorotatedLinear, ElasticLaw::kStVenantKirchhoff}) {
    Material material = WithFibres(10);
    material.law = law;
    const MaterialPoint point(material, {&fibre, 1});
    const PulledBar bar(point, Eigen::Vector3d::UnitX());
    PulledBar::State state = bar.AtRest();
    for (const double strain : {0.01, 0.1, 0.3}) {
      const std::optional<PulledBar::State> next = bar.Pull(strain, state);
      ASSERT_TRUE(next.has_value()) << strain;
      state = *next;
      EXPECT_LT(state.response.stress.rightCols(2).norm(), 1e-9 * state.nominal_stress);
      EXPECT_GT(std::abs(state.g(0, 1)), 1e-3 * strain);  // it shears
    }
  }
}

TEST(PulledBar, DoesWorkThatItsEnergyGains) {
  const Vec3 fibre{1, 1, 0.3};
  const MaterialPoint point(WithFibres(10), {&fibre, 1});
  const PulledBar bar(point, Eigen::Vector3d::UnitX());
  const std::optional<PulledBar::State> at = bar.Pull(0.2, bar.AtRest());
  const double h = 1e-5;
  const double slope =
      (bar.Pull(0.2 + h, *at)->response.energy - bar.Pull(0.2 - h, *at)->response.energy) / (2 * h);
  EXPECT_NEAR(at->nominal_stress, slope, 1e-8 * slope);
}

}  // namespace
}  // namespace cleave
