#include "core/contact/friction_spring.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

using Vector = Eigen::Vector3d;

TEST(FrictionSpring, TheParabolaOfItsStiffnessTouchesItsEnergyAndLiesAboveIt) {
  const FrictionSpring spring{50, 2};  // slips beyond 0.04 m
  const Vector normal(0, 0, 1);
  for (const double length : {0.01, 0.04, 0.1, 3.0}) {
    const Vector at = length * Vector(0.6, 0.8, 0);
    const Eigen::Matrix3d stiffness = spring.Stiffness(at, normal);
    EXPECT_EQ((stiffness * normal).norm(), 0);
    const auto parabola = [&](const Vector& to) {
      const Vector step = to - at;
      return spring.Energy(at.norm()) - spring.Force(at).dot(step) +
             0.5 * step.dot(stiffness * step);
    };
    for (int k = 0; k < 400; ++k) {
      const Vector to(0.02 * (k % 20 - 10), 0.02 * (k / 20 - 10), 0);
      EXPECT_GE(parabola(to), spring.Energy(to.norm()) - 1e-12) << length << " " << k;
    }
    EXPECT_NEAR(parabola(at), spring.Energy(at.norm()), 1e-15);
    EXPECT_NEAR(parabola(-at), spring.Energy(at.norm()), 1e-12);
  }
}

TEST(FrictionSpring, ItsExactStiffnessIsWhatItsForceChangesBy) {
  const FrictionSpring spring{50, 2};
  const Vector normal(0, 0, 1);
  constexpr double kDifference = 1e-7;
  for (const double length : {0.01, 0.03, 0.05, 0.1, 3.0}) {
    const Vector at = length * Vector(0.6, -0.8, 0);
    const Eigen::Matrix3d stiffness = spring.ExactStiffness(at, normal);
    for (int axis = 0; axis < 2; ++axis) {
      const Vector step = kDifference * Vector::Unit(axis);
      const Vector change = (spring.Force(at + step) - spring.Force(at - step)) / (2 * kDifference);
      EXPECT_LT((stiffness.col(axis) + change).norm(), 1e-5) << length << " " << axis;
    }
    EXPECT_EQ((stiffness * normal).norm(), 0);
  }
}

}  // namespace
}  // namespace cleave
