#include "client/io/preview/props.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <variant>

namespace cleave {
namespace {

Eigen::Vector3d ToEigen(const Vec3& v) { return Eigen::Map<const Eigen::Vector3d>(v.data()); }
Vec3 ToVec3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Prop Ball(const SphereShape& sphere) {
  constexpr int kRings = 24;
  constexpr int kSectors = 48;
  Prop prop;
  const auto at = [&](double polar, double around) {
    return Vec3{sphere.center[0] + sphere.radius * std::sin(polar) * std::cos(around),
                sphere.center[1] + sphere.radius * std::sin(polar) * std::sin(around),
                sphere.center[2] + sphere.radius * std::cos(polar)};
  };
  prop.points.push_back(at(0, 0));
  for (int ring = 1; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      prop.points.push_back(
          at(std::numbers::pi * ring / kRings, 2 * std::numbers::pi * sector / kSectors));
    }
  }
  const auto bottom = static_cast<int32_t>(prop.points.size());
  prop.points.push_back(at(std::numbers::pi, 0));
  const auto point = [&](int ring, int sector) {
    return 1 + (ring - 1) * kSectors + sector % kSectors;
  };
  for (int sector = 0; sector < kSectors; ++sector) {
    prop.triangles.push_back({0, point(1, sector), point(1, sector + 1)});
    for (int ring = 1; ring + 1 < kRings; ++ring) {
      prop.triangles.push_back(
          {point(ring, sector), point(ring + 1, sector), point(ring + 1, sector + 1)});
      prop.triangles.push_back(
          {point(ring, sector), point(ring + 1, sector + 1), point(ring, sector + 1)});
    }
    prop.triangles.push_back({bottom, point(kRings - 1, sector + 1), point(kRings - 1, sector)});
  }
  return prop;
}

Prop Box(const BoxShape& box) {
  Prop prop;
  const Eigen::AngleAxisd turn(box.rotation, ToEigen(box.rotation_axis).normalized());
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d from_center = ToEigen(box.size) / 2;
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) == 0) from_center[axis] = -from_center[axis];
    }
    prop.points.push_back(ToVec3(ToEigen(box.center) + turn * from_center));
  }
  // Corners count x in their lowest bit, then y, then z.
  prop.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return prop;
}

}  // namespace

std::vector<Vec3> Prop::PointsAt(int64_t frame) const {
  const auto after = places.upper_bound(frame);
  if (after == places.begin()) return points;
  const PropPlace& place = std::prev(after)->second;
  const auto& [w, x, y, z] = place.rotation;
  const Eigen::Matrix3d turn = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  std::vector<Vec3> moved;
  moved.reserve(points.size());
  for (const Vec3& point : points)
    moved.push_back(ToVec3(turn * ToEigen(point) + ToEigen(place.translation)));
  return moved;
}

std::optional<Prop> PropOf(const Shape& shape) {
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) return Ball(*sphere);
  if (const auto* box = std::get_if<BoxShape>(&shape)) return Box(*box);
  if (const auto* surface = std::get_if<SurfaceShape>(&shape))
    return Prop{surface->vertices, surface->triangles, {}};
  return std::nullopt;
}

ShownSurface PropsAt(std::span<const Prop> props, int64_t frame) {
  ShownSurface all;
  for (const Prop& prop : props) {
    const auto first = static_cast<int32_t>(all.points.size());
    const std::vector<Vec3> points = prop.PointsAt(frame);
    all.points.insert(all.points.end(), points.begin(), points.end());
    for (const auto& [a, b, c] : prop.triangles)
      all.triangles.push_back({first + a, first + b, first + c});
  }
  all.pieces.assign(all.triangles.size(), 0);
  all.inside.assign(all.triangles.size(), 0);
  all.regions.assign(all.triangles.size(), 0);
  return all;
}

std::vector<Vec3> PropPointsNear(std::span<const Prop> props, std::span<const Vec3> body) {
  constexpr double kNear = 0.25;       // of the body's diagonal, around it
  constexpr size_t kMostPoints = 64;   // of a prop at a place
  constexpr int64_t kMostPlaces = 64;  // of a prop
  Eigen::AlignedBox3d around;
  for (const Vec3& point : body) around.extend(ToEigen(point));
  const double diagonal = around.diagonal().norm();
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(kNear * diagonal);
  const Eigen::AlignedBox3d near(around.min() - reach, around.max() + reach);
  std::vector<Vec3> points;
  for (const Prop& prop : props) {
    std::vector<int64_t> frames;
    for (const auto& [frame, place] : prop.places) frames.push_back(frame);
    if (frames.empty()) frames.push_back(0);
    const auto count = static_cast<int64_t>(frames.size());
    const int64_t chosen = std::min(kMostPlaces, count);
    for (int64_t i = 0; i < chosen; ++i) {
      const int64_t frame =
          frames[static_cast<size_t>(chosen == 1 ? 0 : i * (count - 1) / (chosen - 1))];
      const std::vector<Vec3> all = prop.PointsAt(frame);
      Eigen::AlignedBox3d box;
      for (const Vec3& point : all) box.extend(ToEigen(point));
      if (box.isEmpty() || box.diagonal().norm() > diagonal || !near.intersects(box)) continue;
      const size_t stride = (all.size() + kMostPoints - 1) / kMostPoints;
      for (size_t k = 0; k < all.size(); k += stride) points.push_back(all[k]);
    }
  }
  return points;
}

}  // namespace cleave
