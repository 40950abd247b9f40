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
      WorstEdge(5 * pull * pull.transpose(), Matrix3d::Zero(), {}, {}, {2}, Vector3d::UnitX());
  EXPECT_NEAR(worst.ratio, 2.5, 1e-12);
  EXPECT_NEAR(std::abs(worst.direction.dot(pull)), 1, 1e-12);
}

TEST(WorstEdge, IsFoundBetweenTheDirectionsThatAreTriedFirst) {
  Matrix3d shear = Matrix3d::Zero();
  shear(0, 1) = shear(1, 0) = 1;
  const EdgeFailure worst = WorstEdge(shear, Matrix3d::Zero(), {}, {}, {1}, Vector3d::UnitX());
  EXPECT_NEAR(worst.ratio, 1, 1e-12);  // principal stress, at 45 degrees
  EXPECT_NEAR(std::abs(worst.direction.dot(Vector3d(1, 1, 0).normalized())), 1, 1e-9);
}

TEST(WorstEdge, TurnsAwayFromFibresThatStrengthen) {
  const Vector3d fibre = Vector3d::UnitX();
  const MaterialPoint::Fibre family{fibre, 0, 3};
  // Pulled equally along and across the fibre: across it is a third as strong.
  const Matrix3d stress = Vector3d(1, 1, 0).asDiagonal();
  const EdgeFailure worst = WorstEdge(stress, Matrix3d::Zero(), {}, {&family, 1}, {1}, fibre);
  EXPECT_NEAR(worst.ratio, 1, 1e-12);
  EXPECT_NEAR(worst.strength_factor, 1, 1e-9);
  EXPECT_NEAR(std::abs(worst.direction[1]), 1, 1e-9);
}

TEST(WorstEdge, IsCrushedOnlyWhereCompressionHasAStrength) {
  const Matrix3d pressed = -3 * Matrix3d::Identity();
  EXPECT_EQ(WorstEdge(pressed, Matrix3d::Zero(), {}, {}, {1}, Vector3d::UnitX()).ratio, 0);
  const EdgeFailure worst = WorstEdge(pressed, Matrix3d::Zero(), {}, {}, {1, 2}, Vector3d::UnitX());
  EXPECT_TRUE(worst.crushed);
  EXPECT_NEAR(worst.ratio, 1.5, 1e-12);
}

TEST(WorstEdge, IsNamedByItsDirectionBeforeFlow) {
  // Flow has stretched the body along x twofold; an edge that now lies at 45 degrees lay steeper.
  PlasticState plastic;
  plastic.inverse_change = Vector3d(0.5, std::sqrt(2.0), std::sqrt(2.0)).asDiagonal();
  plastic.inverse_change -= Matrix3d::Identity();
  plastic.strain = std::log(2.0);
  const Matrix3d g = Vector3d(1, std::sqrt(0.5) - 1, std::sqrt(0.5) - 1).asDiagonal();  // F_e = I
  Matrix3d shear = Matrix3d::Zero();
  shear(0, 1) = shear(1, 0) = 1;
  const EdgeFailure worst = WorstEdge(shear, g, plastic, {}, {1}, Vector3d::UnitX());
  EXPECT_NEAR(worst.ratio, 1, 1e-12);
  const Vector3d steeper = Vector3d(0.5, std::sqrt(2.0), 0).normalized();
  EXPECT_NEAR(std::abs(worst.direction.dot(steeper)), 1, 1e-9);
}

}  // namespace
}  // namespace cleave
