#include "core/contact/signed_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cleave {
namespace {

Eigen::Vector3d ToEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

SignedDistance BoxDistance(const Eigen::Vector3d& half, const Eigen::Vector3d& point) {
  const Eigen::Vector3d beyond = point.cwiseAbs() - half;
  Eigen::Vector3d sign;
  for (int k = 0; k < 3; ++k) sign[k] = point[k] < 0 ? -1 : 1;
  const Eigen::Vector3d outside = beyond.cwiseMax(0);
  const double length = outside.norm();
  if (length > 0) return {length, (outside / length).cwiseProduct(sign)};
  int axis = 0;
  const double depth = beyond.maxCoeff(&axis);
  return {depth, sign[axis] * Eigen::Vector3d::Unit(axis)};
}

}  // namespace

ShapeDistance::ShapeDistance(const Shape& shape) {
  if (const auto* plane = std::get_if<PlaneShape>(&shape)) {
    center_ = ToEigen(plane->point);
    radius_ = std::numeric_limits<double>::infinity();
    depth_ = radius_;
    shape_ = Plane{ToEigen(plane->normal).normalized()};
  } else if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    center_ = ToEigen(sphere->center);
    radius_ = sphere->radius;
    depth_ = radius_;
    shape_ = Sphere{};
  } else if (const auto* box = std::get_if<BoxShape>(&shape)) {
    center_ = ToEigen(box->center);
    const Eigen::Vector3d half = 0.5 * ToEigen(box->size);
    radius_ = half.norm();
    depth_ = half.minCoeff();
    shape_ = Box{Eigen::AngleAxisd(box->rotation, ToEigen(box->rotation_axis).normalized())
                     .toRotationMatrix(),
                 half};
  } else if (const auto* surface = std::get_if<SurfaceShape>(&shape)) {
    Eigen::Vector3d low = ToEigen(surface->vertices[0]), high = low;
    for (const Vec3& vertex : surface->vertices) {
      low = low.cwiseMin(ToEigen(vertex));
      high = high.cwiseMax(ToEigen(vertex));
    }
    center_ = 0.5 * (low + high);
    for (const Vec3& vertex : surface->vertices)
      radius_ = std::max(radius_, (ToEigen(vertex) - center_).norm());
    // Half the thickness of a plate, a third of the radius of a ball.
    double volume = 0, area = 0;
    for (const auto& [i, j, k] : surface->triangles) {
      const Eigen::Vector3d a = ToEigen(surface->vertices[static_cast<size_t>(i)]) - center_;
      const Eigen::Vector3d b = ToEigen(surface->vertices[static_cast<size_t>(j)]) - center_;
      const Eigen::Vector3d c = ToEigen(surface->vertices[static_cast<size_t>(k)]) - center_;
      volume += a.dot(b.cross(c)) / 6;
      area += (b - a).cross(c - a).norm() / 2;
    }
    depth_ = volume / area;
    shape_.emplace<SurfaceDistance>(surface->vertices, surface->triangles);
  }
}

SignedDistance ShapeDistance::At(const Eigen::Vector3d& point) const {
  if (const auto* plane = std::get_if<Plane>(&shape_))
    return {plane->normal.dot(point - center_), plane->normal};
  if (const auto* box = std::get_if<Box>(&shape_)) {
    SignedDistance distance = BoxDistance(box->half, box->axes.transpose() * (point - center_));
    distance.normal = box->axes * distance.normal;
    return distance;
  }
  if (const auto* surface = std::get_if<SurfaceDistance>(&shape_)) return surface->At(point);
  const Eigen::Vector3d away = point - center_;
  const double length = away.norm();
  return {length - radius_, length > 0 ? Eigen::Vector3d(away / length) : Eigen::Vector3d::UnitZ()};
}

int64_t ShapeDistance::bytes() const {
  const auto* surface = std::get_if<SurfaceDistance>(&shape_);
  return static_cast<int64_t>(sizeof(*this)) + (surface != nullptr ? surface->bytes() : 0);
}

}  // namespace cleave
