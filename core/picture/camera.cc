#include "core/picture/camera.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

constexpr double kHalfHeight = 0.21;  // a 24 degree lens: little distortion, some depth

Vector3d ToEigen(const Vec3& v) { return Vector3d(v[0], v[1], v[2]); }
Vec3 FromEigen(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// z is up unless the body is long along z, or a plate that stands on its edge.
Vector3d ChooseUp(const Vector3d& extent) {
  Eigen::Index longest = 0;
  Eigen::Index thinnest = 0;
  const double most = extent.maxCoeff(&longest);
  const double least = extent.minCoeff(&thinnest);
  const double middle = extent.sum() - most - least;
  if (least < 0.3 * middle) return Vector3d::Unit(thinnest);
  if (longest == 2 && middle < 0.7 * most) return Vector3d::UnitY();
  return Vector3d::UnitZ();
}

// The horizontal direction in which the points spread most; without a clear one, the axis that is
// most nearly horizontal.
Vector3d LongDirection(std::span<const Vec3> points, const Vector3d& mean, const Vector3d& up) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& point : points) {
    Vector3d flat = ToEigen(point) - mean;
    flat -= up * up.dot(flat);
    spread += flat * flat.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  const Vector3d axis = std::abs(up.x()) < 0.8 ? Vector3d::UnitX() : Vector3d::UnitZ();
  Vector3d direction = axis - up * up.dot(axis);
  if (eigen.eigenvalues()[2] > 1.3 * eigen.eigenvalues()[1])
    direction = eigen.eigenvectors().col(2);
  direction.normalize();
  // The sign that lies along the positive axis, so that pictures of one body agree.
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return direction[largest] < 0 ? Vector3d(-direction) : direction;
}

absl::Status CheckFraming(std::span<const Vec3> points, double aspect,
                          const CameraOptions& options) {
  Faults faults;
  if (points.empty()) faults.Error("points", "there is nothing to frame");
  for (size_t i = 0; i < points.size(); ++i) {
    if (ToEigen(points[i]).allFinite()) continue;
    faults.Error(absl::StrCat("points[", i, "]"), "is not finite");
    break;
  }
  if (!(aspect > 0.01 && aspect < 100)) {
    faults.Error("aspect", absl::StrCat(aspect, " is outside (0.01, 100)"));
  }
  faults.Append("", CheckCameraOptions(options));
  return faults.ToStatus();
}

}  // namespace

std::optional<Vec3> UpAgainst(const std::optional<Vec3>& gravity) {
  if (!gravity || *gravity == Vec3{0, 0, 0}) return std::nullopt;
  return Vec3{-(*gravity)[0], -(*gravity)[1], -(*gravity)[2]};
}

Faults CheckCameraOptions(const CameraOptions& options) {
  Faults faults;
  if (options.up && !(ToEigen(*options.up).norm() > 0 && ToEigen(*options.up).allFinite())) {
    faults.Error("up", "must be finite and not zero");
  }
  if (options.azimuth && !std::isfinite(*options.azimuth)) {
    faults.Error("azimuth", absl::StrCat(*options.azimuth, " is not a finite number"));
  }
  if (options.elevation && !(std::abs(*options.elevation) < 89)) {
    faults.Error("elevation", absl::StrCat(*options.elevation, " is outside (-89, 89) degrees"));
  }
  if (!(options.margin >= 0 && options.margin <= 0.45)) {
    faults.Error("margin", absl::StrCat(options.margin, " is outside [0, 0.45]"));
  }
  return faults;
}

absl::StatusOr<Camera> FrameCamera(std::span<const Vec3> points, double aspect,
                                   const CameraOptions& options) {
  CLEAVE_RETURN_IF_ERROR(CheckFraming(points, aspect, options));
  Vector3d low = ToEigen(points[0]);
  Vector3d high = low;
  Vector3d mean = Vector3d::Zero();
  for (const Vec3& point : points) {
    low = low.cwiseMin(ToEigen(point));
    high = high.cwiseMax(ToEigen(point));
    mean += ToEigen(point);
  }
  mean /= static_cast<double>(points.size());
  const Vector3d center = 0.5 * (low + high);
  const double radius = std::max(0.5 * (high - low).norm(), 1e-9);

  const Vector3d up = options.up ? ToEigen(*options.up).normalized() : ChooseUp(high - low);
  const Vector3d along = LongDirection(points, mean, up);
  const Vector3d across = up.cross(along);  // away from a camera square to the long axis
  double ground = std::numeric_limits<double>::infinity();
  double top = -ground;
  double near_side = ground;
  double far_side = -ground;
  for (const Vec3& point : points) {
    ground = std::min(ground, up.dot(ToEigen(point)));
    top = std::max(top, up.dot(ToEigen(point)));
    near_side = std::min(near_side, across.dot(ToEigen(point)));
    far_side = std::max(far_side, across.dot(ToEigen(point)));
  }
  double left_side = std::numeric_limits<double>::infinity();
  double right_side = -left_side;
  for (const Vec3& point : points) {
    left_side = std::min(left_side, along.dot(ToEigen(point)));
    right_side = std::max(right_side, along.dot(ToEigen(point)));
  }
  // A plate is seen from higher up than a column, a long body more squarely than a compact one.
  const double slimness = (far_side - near_side) / std::max(right_side - left_side, 1e-12);
  const double flatness =
      std::clamp(1 - (top - ground) / std::max(far_side - near_side, 1e-12), 0.0, 1.0);
  constexpr double kDegree = std::numbers::pi / 180;
  const double wide = std::clamp(slimness, 0.0, 1.0);
  const double azimuth = options.azimuth.value_or(20 + 12 * wide) * kDegree;
  const double elevation = options.elevation.value_or(18 + flatness * (8 + 14 * wide)) * kDegree;
  const Vector3d level = std::cos(azimuth) * across - std::sin(azimuth) * along;
  const Vector3d forward = std::cos(elevation) * level - std::sin(elevation) * up;
  const Vector3d right = forward.cross(up).normalized();
  const Vector3d view_up = right.cross(forward);

  // Every point p must satisfy |right.(p - c)| <= half_width * forward.(p - c), and the same
  // upward; in each direction the tightest pair of planes fixes the middle and the distance.
  const double half_width = kHalfHeight * aspect;
  const double tangent_x = half_width * (1 - 2 * options.margin);
  const double tangent_y = kHalfHeight * (1 - 2 * options.margin);
  double left_most = -std::numeric_limits<double>::infinity();
  double right_most = left_most;
  double down_most = left_most;
  double up_most = left_most;
  for (const Vec3& point : points) {
    const Vector3d p = ToEigen(point) - center;
    const double depth = forward.dot(p);
    right_most = std::max(right_most, right.dot(p) - tangent_x * depth);
    left_most = std::max(left_most, -right.dot(p) - tangent_x * depth);
    up_most = std::max(up_most, view_up.dot(p) - tangent_y * depth);
    down_most = std::max(down_most, -view_up.dot(p) - tangent_y * depth);
  }
  const double distance = std::max({0.5 * (right_most + left_most) / tangent_x,
                                    0.5 * (up_most + down_most) / tangent_y, 1.2 * radius});
  const Vector3d position = center + 0.5 * (right_most - left_most) * right +
                            0.5 * (up_most - down_most) * view_up - distance * forward;
  return Camera{FromEigen(position), FromEigen(right),
                FromEigen(view_up),  FromEigen(forward),
                half_width,          kHalfHeight,
                FromEigen(center),   radius,
                FromEigen(up),       ground};
}

Camera Turned(const Camera& camera, double angle) {
  const Eigen::AngleAxisd turn(angle, ToEigen(camera.ground_normal));
  const Vector3d center = ToEigen(camera.scene_center);
  Camera turned = camera;
  turned.position = FromEigen(center + turn * (ToEigen(camera.position) - center));
  turned.right = FromEigen(turn * ToEigen(camera.right));
  turned.up = FromEigen(turn * ToEigen(camera.up));
  turned.forward = FromEigen(turn * ToEigen(camera.forward));
  return turned;
}

std::vector<Vec3> TurnedAround(std::span<const Vec3> points, const Camera& camera, int steps) {
  std::vector<Vec3> all;
  const Vector3d center = ToEigen(camera.scene_center);
  for (int step = 0; step < steps; ++step) {
    const Eigen::AngleAxisd turn(2 * std::numbers::pi * step / steps,
                                 ToEigen(camera.ground_normal));
    for (const Vec3& point : points) {
      all.push_back(FromEigen(center + turn * (ToEigen(point) - center)));
    }
  }
  return all;
}

absl::StatusOr<double> NaturalAspect(std::span<const Vec3> points, const CameraOptions& options) {
  CLEAVE_ASSIGN_OR_RETURN(const Camera camera, FrameCamera(points, 1, options));
  double widest = 0;
  double tallest = 0;
  for (const Vec3& point : points) {
    const Vector3d from = ToEigen(point) - ToEigen(camera.position);
    const double depth = ToEigen(camera.forward).dot(from);
    widest = std::max(widest, std::abs(ToEigen(camera.right).dot(from)) / depth);
    tallest = std::max(tallest, std::abs(ToEigen(camera.up).dot(from)) / depth);
  }
  if (widest <= 0 || tallest <= 0) return 1.5;
  return std::clamp(widest / tallest, 0.75, 2.6);
}

}  // namespace cleave
