#include "core/mesh/winding_number.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/mesh/triangle_halves.h"

namespace cleave {
namespace {

constexpr int32_t kLeaf = 8;  // triangles
constexpr double kFar = 2.5;  // radii of a part, from where it is a dipole

// Source: Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983.
double SolidAngle(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * std::atan2(a.dot(b.cross(c)), below);
}

}  // namespace

WindingNumber::WindingNumber(const std::vector<Vec3>& vertices,
                             const std::vector<std::array<int32_t, 3>>& triangles) {
  triangles_.resize(triangles.size());
  for (size_t k = 0; k < triangles.size(); ++k) {
    for (size_t i = 0; i < 3; ++i) {
      const Vec3& vertex = vertices[static_cast<size_t>(triangles[k][i])];
      triangles_[k][i] = {vertex[0], vertex[1], vertex[2]};
    }
  }
  nodes_.reserve(triangles.size());
  Build(0, static_cast<int32_t>(triangles_.size()));
}

int32_t WindingNumber::Build(int32_t begin, int32_t end) {
  const auto index = static_cast<int32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  Eigen::Vector3d low = triangles_[static_cast<size_t>(begin)][0], high = low;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double area = 0;
  for (int32_t k = begin; k < end; ++k) {
    const Triangle& triangle = triangles_[static_cast<size_t>(k)];
    const Eigen::Vector3d normal =
        0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    node.area += normal;
    area += normal.norm();
    moment += normal.norm() / 3 * (triangle[0] + triangle[1] + triangle[2]);
    for (const Eigen::Vector3d& corner : triangle) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  node.center = area > 0 ? Eigen::Vector3d(moment / area) : Eigen::Vector3d(0.5 * (low + high));
  for (int32_t k = begin; k < end; ++k) {
    for (const Eigen::Vector3d& corner : triangles_[static_cast<size_t>(k)])
      node.radius = std::max(node.radius, (corner - node.center).norm());
  }
  if (end - begin > kLeaf) {
    const int32_t middle = SplitInHalves(
        high - low, begin, end, triangles_,
        [](const Triangle& triangle) -> const auto& { return triangle; });
    Build(begin, middle);
    node.right = Build(middle, end);
  }
  nodes_[static_cast<size_t>(index)] = node;
  return index;
}

double WindingNumber::At(const Eigen::Vector3d& point) const {
  double angle = 0;
  std::array<int32_t, 64> stack;
  size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const int32_t index = stack[--depth];
    const Node& node = nodes_[static_cast<size_t>(index)];
    const Eigen::Vector3d away = node.center - point;
    const double distance = away.norm();
    if (distance > kFar * node.radius) {
      angle += node.area.dot(away) / (distance * distance * distance);
    } else if (node.right < 0) {
      for (int32_t k = node.begin; k < node.end; ++k)
        angle += SolidAngle(triangles_[static_cast<size_t>(k)], point);
    } else {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
    }
  }
  return angle / (4 * std::numbers::pi);
}

}  // namespace cleave
