#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/material/corotated_linear.h"
#include "core/material/invertible_neo_hookean.h"
#include "core/material/moduli.h"
#include "core/material/st_venant_kirchhoff.h"
#include "core/material/stable_neo_hookean.h"
#include "tests/unit/core/material/law_calculus.h"
#include "tests/unit/core/material/reference_values.h"

namespace cleave {
namespace {

template <typename T = Double4>
LameConstants<T> ReferenceLame() {
  const auto lame = ToLame(reference::kYoungsModulus, reference::kPoissonRatio);
  return {Splat<T>(lame.mu), Splat<T>(lame.lambda)};
}

template <typename Law>
class IsotropicLaw : public ::testing::Test {};
using Laws =
    ::testing::Types<StableNeoHookean, InvertibleNeoHookean, CorotatedLinear, StVenantKirchhoff>;
TYPED_TEST_SUITE(IsotropicLaw, Laws);

// Singular values on both sides of inversion, none near s_i + s_j = 0 or a kink of the extended
// logarithm's third derivative.
const Eigen::Vector3d kStretches[] = {
    {1.02, 1.0, 0.97},  {1.5, 1.2, 0.4},          {2.5, 0.3, 0.2},  {1.0, 1.0, 1.0},
    {0.5, 0.5, 0.5},    {1.3, 0.8, -0.3},         {1.1, 0.7, 0.05}, {0.08, 0.06, 0.03},
    {1.2, 0.09, -0.04}, {1.0 + 1e-9, 1, 1 - 1e-9}};

TYPED_TEST(IsotropicLaw, StressIsTheDerivativeOfEnergy) {
  std::mt19937 random(1);
  const auto lame = ReferenceLame();
  for (const Eigen::Vector3d& stretches : kStretches) {
    for (int repeat = 0; repeat < 5; ++repeat) {
      const Eigen::Matrix3d f = RandomGradient(random, stretches);
      const Eigen::Matrix3d stress = StressAt<TypeParam>(f, lame);
      Eigen::Matrix3d difference;
      constexpr double h = 1e-5;
      for (int k = 0; k < 9; ++k) {
        // Richardson's combination of two central differences: the error is of order h^4.
        const auto slope = [&](double step) {
          Eigen::Matrix3d up = f, down = f;
          up(k / 3, k % 3) += step;
          down(k / 3, k % 3) -= step;
          return (EnergyAt<TypeParam>(up, lame) - EnergyAt<TypeParam>(down, lame)) / (2 * step);
        };
        difference(k / 3, k % 3) = (4 * slope(h) - slope(2 * h)) / 3;
      }
      const double scale = stress.norm() + reference::kYoungsModulus;
      EXPECT_LT((stress - difference).norm(), 1e-7 * scale) << stretches.transpose();
    }
  }
}

TYPED_TEST(IsotropicLaw, SecondDerivativeIsTheDerivativeOfStress) {
  std::mt19937 random(2);
  const auto lame = ReferenceLame();
  for (const Eigen::Vector3d& stretches : kStretches) {
    for (int repeat = 0; repeat < 5; ++repeat) {
      const Eigen::Matrix3d f = RandomGradient(random, stretches);
      const SignedSvd svd = ComputeSvd(DisplacementGradientOf(f));
      const Matrix9d stiffness = SecondDerivative(svd, TypeParam::Spectrum(svd, lame));
      Matrix9d difference;
      constexpr double h = 1e-5;
      for (int k = 0; k < 9; ++k) {
        const auto slope_over = [&](double step) -> Eigen::Matrix3d {
          Eigen::Matrix3d up = f, down = f;
          up(k / 3, k % 3) += step;
          down(k / 3, k % 3) -= step;
          return (StressAt<TypeParam>(up, lame) - StressAt<TypeParam>(down, lame)) / (2 * step);
        };
        const Eigen::Matrix3d slope = (4 * slope_over(h) - slope_over(2 * h)) / 3;
        for (int row = 0; row < 9; ++row) difference(row, k) = slope(row / 3, row % 3);
      }
      EXPECT_LT((stiffness - difference).norm(), 1e-7 * stiffness.norm()) << stretches.transpose();
    }
  }
}

// What does not depend on the precision but for the digits that it leaves.
template <typename LawAndBatch>
class ElasticLawInBothPrecisions : public ::testing::Test {
 protected:
  using LawOfTest = typename LawAndBatch::first_type;
  using Batch = typename LawAndBatch::second_type;
  static constexpr double kRounding = Lanes<Batch>::kRounding;
};
using LawsInBothPrecisions =
    ::testing::Types<std::pair<StableNeoHookean, Double4>, std::pair<StableNeoHookean, Float8>,
                     std::pair<InvertibleNeoHookean, Double4>,
                     std::pair<InvertibleNeoHookean, Float8>, std::pair<CorotatedLinear, Double4>,
                     std::pair<CorotatedLinear, Float8>, std::pair<StVenantKirchhoff, Double4>,
                     std::pair<StVenantKirchhoff, Float8>>;
TYPED_TEST_SUITE(ElasticLawInBothPrecisions, LawsInBothPrecisions);

TYPED_TEST(IsotropicLaw, FloatHasTheDigitsOfFloat) {
  std::mt19937 random(6);
  const auto lame = ReferenceLame();
  const auto narrow = ReferenceLame<Float8>();
  for (const Eigen::Vector3d& stretches : kStretches) {
    const Eigen::Matrix3d f =
        RandomGradient(random, stretches).template cast<float>().template cast<double>();
    const SignedSvd svd = ComputeSvd(DisplacementGradientOf(f));
    const Matrix9d stiffness = SecondDerivative(svd, TypeParam::Spectrum(svd, lame));
    // Stress errs by the rounding of strain, and energy by stress times that.
    const double rounding = 1e-6 * stiffness.norm();
    const Eigen::Matrix3d stress = StressAt<TypeParam>(f, lame);
    EXPECT_NEAR(EnergyAt<TypeParam>(f, narrow), EnergyAt<TypeParam>(f, lame),
                1e-6 * (EnergyAt<TypeParam>(f, lame) + stress.norm() + rounding))
        << stretches.transpose();
    EXPECT_LT((StressAt<TypeParam>(f, narrow) - stress).norm(), rounding) << stretches.transpose();
    const SignedSvd narrow_svd = ComputeSvd(DisplacementGradientOf<Float8>(f));
    const Matrix9d narrow_stiffness =
        SecondDerivative(narrow_svd, TypeParam::Spectrum(narrow_svd, narrow));
    EXPECT_LT((narrow_stiffness - stiffness).norm(), 3e-5 * stiffness.norm())
        << stretches.transpose();
  }
}

TYPED_TEST(ElasticLawInBothPrecisions, ProjectedSecondDerivativeHasNoNegativeEigenvalue) {
  using Law = typename TestFixture::LawOfTest;
  using T = typename TestFixture::Batch;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> stretch(-1.5, 2.5);
  const auto lame = ReferenceLame<T>();
  for (int repeat = 0; repeat < 300; ++repeat) {
    const Eigen::Matrix3d f =
        RandomGradient(random, {stretch(random), stretch(random), stretch(random)});
    const SignedSvd svd = ComputeSvd(DisplacementGradientOf<T>(f));
    StiffnessSpectrum<T> spectrum = Law::Spectrum(svd, lame);
    ProjectToSemidefinite(spectrum);
    const Eigen::SelfAdjointEigenSolver<Matrix9d> solver(SecondDerivative(svd, spectrum));
    EXPECT_GE(solver.eigenvalues()(0),
              -std::max(1e-9, 10 * TestFixture::kRounding) * solver.eigenvalues()(8));
  }
}

TYPED_TEST(ElasticLawInBothPrecisions, EnergyAndStressDoNotSeeRotations) {
  using Law = typename TestFixture::LawOfTest;
  using T = typename TestFixture::Batch;
  std::mt19937 random(4);
  const auto lame = ReferenceLame<T>();
  const Eigen::Matrix3d f = RandomGradient(random, {1.4, 0.9, 0.6});
  const Eigen::Matrix3d rotation = RandomGradient(random, {1, 1, 1});
  const double rounding = 100 * TestFixture::kRounding;
  EXPECT_NEAR(EnergyAt<Law>(rotation, lame), 0, rounding * rounding * reference::kYoungsModulus);
  EXPECT_LT(StressAt<Law>(rotation, lame).norm(), rounding * reference::kYoungsModulus);
  const double energy = EnergyAt<Law>(f, lame);
  EXPECT_NEAR(EnergyAt<Law>(rotation * f, lame), energy, rounding * energy);
  EXPECT_LT((StressAt<Law>(rotation * f, lame) - rotation * StressAt<Law>(f, lame)).norm(),
            rounding * StressAt<Law>(f, lame).norm());
}

TYPED_TEST(ElasticLawInBothPrecisions, ASmallStrainHasItsEnergyHoweverTheBodyHasTurned) {
  using Law = typename TestFixture::LawOfTest;
  using T = typename TestFixture::Batch;
  std::mt19937 random(8);
  const auto lame = ReferenceLame<T>();
  const double strain = 1e3 * TestFixture::kRounding;
  const double mu = lame.mu[0], lambda = lame.lambda[0];
  const double expected = (0.5 * lambda + mu) * strain * strain;
  for (int repeat = 0; repeat < 20; ++repeat) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 0) += strain;
    EXPECT_NEAR(EnergyAt<Law>(RandomGradient(random, {1, 1, 1}) * f, lame), expected,
                0.02 * expected);
  }
}

// What a break takes from a tet is a share of its energy, so no break may give any.
TYPED_TEST(ElasticLawInBothPrecisions, EnergyIsNeverNegative) {
  using Law = typename TestFixture::LawOfTest;
  using T = typename TestFixture::Batch;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> stretch(-2, 3), small(-1e-3, 1e-3);
  for (const double poisson_ratio : {0.0, 0.1, 0.3, 0.45, 0.4999}) {
    const auto lame = ToLame(reference::kYoungsModulus, poisson_ratio);
    const LameConstants<T> batch{Splat<T>(lame.mu), Splat<T>(lame.lambda)};
    for (int repeat = 0; repeat < 200; ++repeat) {
      const Eigen::Vector3d near_rest(1 + small(random), 1 + small(random), 1 + small(random));
      const Eigen::Vector3d far(stretch(random), stretch(random), stretch(random));
      for (const Eigen::Vector3d& stretches : {near_rest, far}) {
        EXPECT_GE(EnergyAt<Law>(RandomGradient(random, stretches), batch), 0)
            << poisson_ratio << ": " << stretches.transpose();
      }
    }
  }
}

TYPED_TEST(ElasticLawInBothPrecisions, EveryStateIsFinite) {
  using Law = typename TestFixture::LawOfTest;
  using T = typename TestFixture::Batch;
  std::mt19937 random(5);
  const auto lame = ReferenceLame<T>();
  const Eigen::Vector3d states[] = {{1, 1, 0},    {1, 0, 0},      {0, 0, 0},     {1, 1, -1},
                                    {2, 1, -1},   {1, 1e-20, 0},  {1e6, 1, 1},   {1e6, 1e-6, -1e-6},
                                    {-3, -3, -3}, {1e-200, 0, 0}, {1, 0.1, 0.1}, {0.1, 0.1, -0.1}};
  for (const Eigen::Vector3d& state : states) {
    for (const Eigen::Matrix3d& f :
         {Eigen::Matrix3d(state.asDiagonal()), RandomGradient(random, state)}) {
      EXPECT_TRUE(std::isfinite(EnergyAt<Law>(f, lame))) << state.transpose();
      EXPECT_TRUE(StressAt<Law>(f, lame).allFinite()) << state.transpose();
      const SignedSvd svd = ComputeSvd(DisplacementGradientOf<T>(f));
      StiffnessSpectrum<T> spectrum = Law::Spectrum(svd, lame);
      ProjectToSemidefinite(spectrum);
      EXPECT_TRUE(SecondDerivative(svd, spectrum).allFinite()) << state.transpose();
    }
  }
}

TYPED_TEST(ElasticLawInBothPrecisions, SmallStrainsFollowHookesLawToTheirLastDigits) {
  using Law = typename TestFixture::LawOfTest;
  using T = typename TestFixture::Batch;
  const auto lame = ReferenceLame<T>();
  constexpr double strain = 1e-12;
  Matrix3<T> g = DisplacementGradientOf<T>(Eigen::Matrix3d::Identity());
  g(0, 0) = Splat<T>(strain);
  const double rounding = (10 * TestFixture::kRounding + 5 * strain) * reference::kYoungsModulus;
  const auto kinematics = Law::KinematicsOf(g);
  const double mu = lame.mu[0], lambda = lame.lambda[0];
  EXPECT_NEAR(Law::Energy(g, kinematics, lame)[0] / (strain * strain), mu + lambda / 2, rounding);
  const Eigen::Matrix3d stress = FirstLane(Law::Stress(g, kinematics, lame)) / strain;
  EXPECT_NEAR(stress(0, 0), 2 * mu + lambda, rounding);
  EXPECT_NEAR(stress(1, 1), lambda, rounding);
}

template <typename Law>
void ExpectReference(const reference::Response* responses) {
  const auto lame = ReferenceLame();
  for (size_t k = 0; k < std::size(reference::kDeformationGradients); ++k) {
    const auto& [name, rows] = reference::kDeformationGradients[k];
    SCOPED_TRACE(name);
    const Eigen::Matrix3d f = MatrixOf(rows);
    const auto& [energy, stress, eigenvalues] = responses[k];
    EXPECT_NEAR(EnergyAt<Law>(f, lame), energy, 1e-11 * (energy + 1));
    const Eigen::Matrix3d expected = MatrixOf(stress);
    EXPECT_LT((StressAt<Law>(f, lame) - expected).norm(), 1e-11 * (expected.norm() + 1));
    if (eigenvalues == std::array<double, 9>{}) continue;
    const SignedSvd svd = ComputeSvd(DisplacementGradientOf(f));
    const Eigen::SelfAdjointEigenSolver<Matrix9d> solver(
        SecondDerivative(svd, Law::Spectrum(svd, lame)));
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(solver.eigenvalues()(i), eigenvalues[static_cast<size_t>(i)],
                  1e-11 * (std::abs(eigenvalues[8]) + std::abs(eigenvalues[0])));
    }
  }
}

// Where s_i + s_j passes 0 the quotient has no bound: the cap of the method note, section 5.
template <typename Law>
void ExpectSkewStiffnessWithin(double cap) {
  const auto lame = ReferenceLame();
  bool met = false;
  for (const double sum : {1e-3, 1e-6, 1e-9, 1e-12, 0.0}) {
    const Eigen::Matrix3d f = Eigen::Vector3d(1.2, 1, -1 + sum).asDiagonal();
    const auto spectrum = Law::Spectrum(ComputeSvd(DisplacementGradientOf(f)), lame);
    for (const Double4& skew : spectrum.skew) {
      EXPECT_LE(std::abs(skew[0]), cap * (1 + 1e-12) + 2 * lame.mu[0]) << sum;
      met = met || std::abs(skew[0]) > 0.99 * cap;
    }
  }
  EXPECT_TRUE(met);
}

TEST(InvertibleNeoHookean, SkewStiffnessIsCapped) {
  const auto lame = ReferenceLame();
  ExpectSkewStiffnessWithin<InvertibleNeoHookean>(1e3 * (lame.mu[0] + lame.lambda[0]) / 0.01);
}
TEST(CorotatedLinear, SkewStiffnessIsCapped) {
  const auto lame = ReferenceLame();
  ExpectSkewStiffnessWithin<CorotatedLinear>(1e3 * (lame.mu[0] + lame.lambda[0]));
}

TEST(StableNeoHookean, MatchesTheReference) {
  ExpectReference<StableNeoHookean>(reference::kStableNeoHookean);
}
TEST(InvertibleNeoHookean, MatchesTheReference) {
  ExpectReference<InvertibleNeoHookean>(reference::kInvertibleNeoHookean);
}
TEST(CorotatedLinear, MatchesTheReference) {
  ExpectReference<CorotatedLinear>(reference::kCorotatedLinear);
}

}  // namespace
}  // namespace cleave
