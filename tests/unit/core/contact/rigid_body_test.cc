#include "core/contact/rigid_body.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/unit/core/contact/test_surfaces.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d Inertia(const MassProperties& mass) {
  return mass.axes * mass.moments.asDiagonal() * mass.axes.transpose();
}

TEST(RigidBody, ASphereOfSteelWeighsWhatTheBookSays) {
  RigidBody body;
  body.density = 7850;
  const MassProperties mass = MassOf(SphereShape{{1, 2, 3}, 0.05}, body);
  EXPECT_NEAR(mass.mass, 4.1103, 1e-4);
  EXPECT_LT((mass.moments - Vector3d::Constant(0.4 * mass.mass * 0.05 * 0.05)).norm(), 1e-12);
  EXPECT_EQ(mass.center, Vector3d(1, 2, 3));
}

TEST(RigidBody, ATurnedBoxHasTheMassAndInertiaOfItsSurface) {
  RigidBody body;
  body.mass = 12;
  const MassProperties box = MassOf(BoxShape{{4, 5, 6}, {1, 2, 3}, {0, 0, 1}, 0}, body);
  const MassProperties surface = MassOf(Shape(BoxSurface({4, 5, 6}, {1, 2, 3})), body);
  EXPECT_LT((Inertia(box) - Matrix3d(Vector3d(13, 10, 5).asDiagonal())).norm(), 1e-9);
  EXPECT_LT((Inertia(surface) - Inertia(box)).norm(), 1e-9);
  EXPECT_LT((surface.center - box.center).norm(), 1e-12);
  EXPECT_NEAR(surface.axes.determinant(), 1, 1e-12);
}

TEST(RigidBody, RotationsByVectorsAreThoseAboutTheirAxes) {
  const Vector3d vector(0.3, -1.2, 0.7);
  const Matrix3d expected =
      Eigen::AngleAxisd(vector.norm(), vector.normalized()).toRotationMatrix();
  EXPECT_LT((RotationBy(vector) - expected).norm(), 1e-14);
  EXPECT_EQ(RotationBy(Vector3d::Zero()), Matrix3d::Identity());
}

TEST(RigidBody, RotationChangeIsTheDerivativeOfRotation) {
  for (const double size : {0.0, 1e-3, 1.0, 3.0}) {
    const Vector3d vector = size * Vector3d(0.6, 0, -0.8);
    const Matrix3d change = RotationChange(vector);
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-6;
      const Matrix3d slope = (RotationBy(vector + kStep * Vector3d::Unit(axis)) -
                              RotationBy(vector - kStep * Vector3d::Unit(axis))) /
                             (2 * kStep) * RotationBy(vector).transpose();
      EXPECT_LT((slope - CrossMatrix(change.col(axis))).norm(), 1e-8) << size;
    }
  }
}

}  // namespace
}  // namespace cleave
