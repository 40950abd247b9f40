#include "core/probe/edge_failure.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(WorstEdge, LiesAlongThePull) {
  const Vector3d pull = Vector3d(1, -2, 3).normalized();
  const EdgeFailure worst =
      WorstEdge(5 * pull * pull.transpose(), Matrix3d::Zero(), {}, 2, Vector3d::UnitX());
  EXPECT_NEAR(worst.ratio, 2.5, 1e-12);
  EXPECT_NEAR(std::abs(worst.direction.dot(pull)), 1, 1e-12);
}

TEST(WorstEdge, IsFoundBetweenTheDirectionsThatAreTriedFirst) {
  Matrix3d shear = Matrix3d::Zero();
  shear(0, 1) = shear(1, 0) = 1;
  const EdgeFailure worst = WorstEdge(shear, Matrix3d::Zero(), {}, 1, Vector3d::UnitX());
  EXPECT_NEAR(worst.ratio, 1, 1e-12);  // principal stress, at 45 degrees
  EXPECT_NEAR(std::abs(worst.direction.dot(Vector3d(1, 1, 0).normalized())), 1, 1e-9);
}

TEST(WorstEdge, TurnsAwayFromFibresThatStrengthen) {
  const Vector3d fibre = Vector3d::UnitX();
  const MaterialPoint::Fibre family{fibre, 0, 3};
  // Pulled equally along and across the fibre: across it is a third as strong.
  const Matrix3d stress = Vector3d(1, 1, 0).asDiagonal();
  const EdgeFailure worst = WorstEdge(stress, Matrix3d::Zero(), {&family, 1}, 1, fibre);
  EXPECT_NEAR(worst.ratio, 1, 1e-12);
  EXPECT_NEAR(worst.strength_factor, 1, 1e-9);
  EXPECT_NEAR(std::abs(worst.direction[1]), 1, 1e-9);
}

TEST(WorstEdge, BreaksNothingInCompression) {
  EXPECT_LT(WorstEdge(-Matrix3d::Identity(), Matrix3d::Zero(), {}, 1, Vector3d::UnitX()).ratio, 0);
}

}  // namespace
}  // namespace cleave
