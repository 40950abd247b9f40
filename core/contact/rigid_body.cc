#include "core/contact/rigid_body.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace cleave {
namespace {

Eigen::Vector3d ToEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

// Of unit density: volume, first moments over volume, and the integral of x x^T about the centre.
struct Moments {
  double volume = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Moments MomentsOf(const SurfaceShape& surface) {
  // Signed tets from one of the vertices, which keeps digits far from the origin.
  const Eigen::Vector3d apex = ToEigen(surface.vertices[0]);
  Moments sum;
  for (const auto& triangle : surface.triangles) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) {
      corners.col(i) =
          ToEigen(surface.vertices[static_cast<size_t>(triangle[static_cast<size_t>(i)])]) - apex;
    }
    const double volume = corners.determinant() / 6;
    const Eigen::Vector3d total = corners.rowwise().sum();
    sum.volume += volume;
    sum.center += volume / 4 * total;
    sum.second += volume / 20 * (total * total.transpose() + corners * corners.transpose());
  }
  sum.center /= sum.volume;
  sum.second -= sum.volume * sum.center * sum.center.transpose();
  sum.center += apex;
  return sum;
}

}  // namespace

MassProperties MassOf(const Shape& shape, const RigidBody& body) {
  Moments moments;
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    const double r = sphere->radius;
    moments.volume = 4 * std::numbers::pi / 3 * r * r * r;
    moments.center = ToEigen(sphere->center);
    moments.second = moments.volume * r * r / 5 * Eigen::Matrix3d::Identity();
  } else if (const auto* box = std::get_if<BoxShape>(&shape)) {
    const Eigen::Vector3d size = ToEigen(box->size);
    const Eigen::Matrix3d axes =
        Eigen::AngleAxisd(box->rotation, ToEigen(box->rotation_axis).normalized())
            .toRotationMatrix();
    moments.volume = size.prod();
    moments.center = ToEigen(box->center);
    moments.second = axes *
                     Eigen::Vector3d(moments.volume / 12 * size.cwiseProduct(size)).asDiagonal() *
                     axes.transpose();
  } else if (const auto* surface = std::get_if<SurfaceShape>(&shape)) {
    moments = MomentsOf(*surface);
  }
  MassProperties properties;
  properties.mass = body.mass.has_value() ? *body.mass : *body.density * moments.volume;
  properties.center = moments.center;
  const Eigen::Matrix3d second = properties.mass / moments.volume * moments.second;
  const Eigen::Matrix3d inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  properties.moments = solver.eigenvalues();
  properties.axes = solver.eigenvectors();
  if (properties.axes.determinant() < 0) properties.axes.col(0) *= -1;
  return properties;
}

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Matrix3d RotationBy(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  const Eigen::Matrix3d cross = CrossMatrix(vector);
  const double half = angle > 0 ? std::sin(angle / 2) / (angle / 2) : 1;
  const double sine = angle > 0 ? std::sin(angle) / angle : 1;
  return Eigen::Matrix3d::Identity() + sine * cross + half * half / 2 * cross * cross;
}

Eigen::Matrix3d RotationChange(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  const Eigen::Matrix3d cross = CrossMatrix(vector);
  const double half = angle > 0 ? std::sin(angle / 2) / (angle / 2) : 1;
  // (angle - sin angle) / angle^3 without cancellation.
  const double third = angle > 1e-2 ? (angle - std::sin(angle)) / (angle * angle * angle)
                                    : 1.0 / 6 - angle * angle / 120;
  return Eigen::Matrix3d::Identity() + half * half / 2 * cross + third * cross * cross;
}

}  // namespace cleave
