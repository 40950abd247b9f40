#include "core/material/fibre.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "tests/unit/core/material/law_calculus.h"
#include "tests/unit/core/material/reference_values.h"

namespace cleave {
namespace {

const Eigen::Vector3d kDirection(reference::kFibreDirection.data());

struct Response {
  double energy;
  Eigen::Matrix3d stress;
  Matrix9d stiffness;
};

double SignAt(const Eigen::Matrix3d& f) {
  const Double4 a[3] = {Splat(kDirection[0]), Splat(kDirection[1]), Splat(kDirection[2])};
  return f.determinant() < 0 ? FibreSign(ComputeSvd(DisplacementGradientOf(f)), a)[0] : 1;
}

// With a stiffness of reference::kFibreModulus and the given sign.
Response ResponseAt(const Eigen::Matrix3d& f, double sign) {
  const Double4 a[3] = {Splat(kDirection[0]), Splat(kDirection[1]), Splat(kDirection[2])};
  const Eigen::Vector3d moved = (f - Eigen::Matrix3d::Identity()) * kDirection;
  const Double4 ga[3] = {Splat(moved[0]), Splat(moved[1]), Splat(moved[2])};
  FibreStretch stretch = StretchFibre(a, ga, Splat(sign));
  if (Any(IsCollapsed(stretch)))
    SetCollapsedDirection(ComputeSvd(DisplacementGradientOf(f)), a, stretch);
  const Eigen::Vector3d d(stretch.direction[0][0], stretch.direction[1][0],
                          stretch.direction[2][0]);
  const double excess = stretch.excess[0];
  const double across = FibreStiffnessAcross(stretch)[0];
  Response response;
  response.energy = 0.5 * reference::kFibreModulus * excess * excess;
  response.stress = reference::kFibreModulus * excess * d * kDirection.transpose();
  const Eigen::Matrix3d in_v =
      across * Eigen::Matrix3d::Identity() + (1 - across) * d * d.transpose();
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column) {
      response.stiffness(row, column) = reference::kFibreModulus * in_v(row / 3, column / 3) *
                                        kDirection[row % 3] * kDirection[column % 3];
    }
  }
  return response;
}

TEST(Fibre, MatchesTheReference) {
  for (size_t k = 0; k < std::size(reference::kDeformationGradients); ++k) {
    SCOPED_TRACE(reference::kDeformationGradients[k].name);
    const Eigen::Matrix3d f = MatrixOf(reference::kDeformationGradients[k].f);
    const auto& expected = reference::kFibre[k];
    EXPECT_EQ(SignAt(f), 1);
    const Response response = ResponseAt(f, SignAt(f));
    EXPECT_NEAR(response.energy, expected.energy, 1e-11 * (expected.energy + 1));
    const Eigen::Matrix3d stress = MatrixOf(expected.stress);
    EXPECT_LT((response.stress - stress).norm(), 1e-11 * (stress.norm() + 1));
    const Eigen::SelfAdjointEigenSolver<Matrix9d> solver(response.stiffness);
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(solver.eigenvalues()(i), expected.eigenvalues[static_cast<size_t>(i)],
                  1e-11 * reference::kFibreModulus);
    }
  }
}

TEST(Fibre, ItsSignTurnsWhenInversionTurnsTheFibreOver) {
  // The smallest stretch is negative; what counts is where the fibre lies to it.
  Eigen::Matrix3d f = Eigen::Vector3d(-0.9, 1, 1).asDiagonal();
  EXPECT_EQ(SignAt(f), 1);  // -0.9 * 0.36 + 0.64 > 0
  f = Eigen::Vector3d(1, -0.9, 1).asDiagonal();
  EXPECT_EQ(SignAt(f), -1);  // 0.36 - 0.9 * 0.64 < 0
}

TEST(Fibre, StressAndStiffnessAreDerivativesForEitherSign) {
  std::mt19937 random(3);
  for (const double sign : {1.0, -1.0}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      const Eigen::Matrix3d f = RandomGradient(random, {1.6, 0.9, repeat % 2 == 0 ? 0.4 : -0.4});
      const Response response = ResponseAt(f, sign);
      Eigen::Matrix3d stress;
      Matrix9d stiffness;
      constexpr double h = 1e-6;
      for (int k = 0; k < 9; ++k) {
        Eigen::Matrix3d up = f, down = f;
        up(k / 3, k % 3) += h;
        down(k / 3, k % 3) -= h;
        const Response above = ResponseAt(up, sign), below = ResponseAt(down, sign);
        stress(k / 3, k % 3) = (above.energy - below.energy) / (2 * h);
        const Eigen::Matrix3d slope = (above.stress - below.stress) / (2 * h);
        for (int row = 0; row < 9; ++row) stiffness(row, k) = slope(row / 3, row % 3);
      }
      EXPECT_LT((response.stress - stress).norm(), 1e-7 * reference::kFibreModulus);
      EXPECT_LT((response.stiffness - stiffness).norm(), 1e-7 * response.stiffness.norm());
    }
  }
}

TEST(Fibre, ACollapsedFibreIsFiniteAndPushesAlongTheTurnOfTheSolid) {
  // Flattened along the fibre, then turned by a right angle about z.
  Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - kDirection * kDirection.transpose();
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Response response = ResponseAt(turn * flat, 1);
  EXPECT_TRUE(response.stiffness.allFinite());
  const Eigen::Vector3d pushed = turn * kDirection;
  EXPECT_LT((response.stress + reference::kFibreModulus * pushed * kDirection.transpose()).norm(),
            1e-6 * reference::kFibreModulus);
  EXPECT_TRUE(ResponseAt(Eigen::Matrix3d::Zero(), -1).stiffness.allFinite());
}

}  // namespace
}  // namespace cleave
