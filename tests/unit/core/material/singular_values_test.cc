#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "core/material/isotropic_stiffness.h"
#include "tests/unit/core/material/law_calculus.h"

namespace cleave {
namespace {

void ExpectFactors(const Eigen::Matrix3d& f) {
  const SignedSvd svd = ComputeSvd(DisplacementGradientOf(f));
  const Eigen::Matrix3d u = FirstLane(svd.u), v = FirstLane(svd.v);
  const Eigen::Vector3d s(svd.s[0][0], svd.s[1][0], svd.s[2][0]);
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  EXPECT_LT((u * u.transpose() - identity).norm(), 1e-13) << f;
  EXPECT_LT((v * v.transpose() - identity).norm(), 1e-13) << f;
  EXPECT_GT(u.determinant(), 0) << f;
  EXPECT_GT(v.determinant(), 0) << f;
  EXPECT_GE(s[0], s[1] - 1e-15 * s[0]) << f;
  EXPECT_GE(s[1], std::abs(s[2]) - 1e-8 * s[0]) << f;
  EXPECT_LE((u * s.asDiagonal() * v.transpose() - f).norm(), 1e-7 * f.norm()) << f;
}

TEST(SingularValues, FactorUprightFlatInvertedAndCollapsedMatrices) {
  std::mt19937 random(7);
  for (const Eigen::Vector3d& stretches :
       {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(2, 1, 0.5), Eigen::Vector3d(2, 1, -0.5),
        Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 0),
        Eigen::Vector3d(1e5, 1, 1e-4), Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(-1, -1, -1)}) {
    ExpectFactors(stretches.asDiagonal());
    for (int repeat = 0; repeat < 20; ++repeat) ExpectFactors(RandomGradient(random, stretches));
  }
}

TEST(SingularValues, KeepTheDigitsOfSmallStrains) {
  Matrix3<Double4> g = DisplacementGradientOf(Eigen::Matrix3d::Identity());
  g(0, 0) = Splat(3e-17);
  g(1, 1) = Splat(-2e-14);
  const SignedSvd svd = ComputeSvd(g);
  EXPECT_NEAR(svd.strain[0][0], 3e-17, 1e-30);
  EXPECT_EQ(svd.strain[1][0], 0);
  EXPECT_NEAR(svd.strain[2][0], -2e-14, 1e-27);
}

}  // namespace
}  // namespace cleave
