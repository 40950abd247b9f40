#include "core/mesh/surface_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/mesh/triangle_halves.h"

namespace cleave {
namespace {

constexpr int32_t kLeaf = 4;  // triangles

double SquaredDistanceToBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                            const Eigen::Vector3d& point) {
  return (point - point.cwiseMax(low).cwiseMin(high)).squaredNorm();
}

}  // namespace

SurfaceDistance::SurfaceDistance(const std::vector<Vec3>& vertices,
                                 const std::vector<std::array<int32_t, 3>>& triangles) {
  std::vector<Eigen::Vector3d> vertex_normals(vertices.size(), Eigen::Vector3d::Zero());
  std::map<std::pair<int32_t, int32_t>, Eigen::Vector3d> edge_normals;
  const auto key = [](int32_t a, int32_t b) { return std::pair(std::min(a, b), std::max(a, b)); };
  triangles_.resize(triangles.size());
  for (size_t k = 0; k < triangles.size(); ++k) {
    Triangle& triangle = triangles_[k];
    triangle.id = static_cast<int32_t>(k);
    for (size_t i = 0; i < 3; ++i) {
      triangle.corners[i] =
          Eigen::Map<const Eigen::Vector3d>(vertices[static_cast<size_t>(triangles[k][i])].data());
    }
    triangle.face = (triangle.corners[1] - triangle.corners[0])
                        .cross(triangle.corners[2] - triangle.corners[0])
                        .normalized();
    for (size_t i = 0; i < 3; ++i) {
      const int32_t from = triangles[k][i], to = triangles[k][(i + 1) % 3];
      const Eigen::Vector3d next =
          (triangle.corners[(i + 1) % 3] - triangle.corners[i]).normalized();
      const Eigen::Vector3d last =
          (triangle.corners[(i + 2) % 3] - triangle.corners[i]).normalized();
      const double angle = std::acos(std::clamp(next.dot(last), -1.0, 1.0));
      vertex_normals[static_cast<size_t>(from)] += angle * triangle.face;
      edge_normals.try_emplace(key(from, to), Eigen::Vector3d::Zero()).first->second +=
          triangle.face;
    }
  }
  for (size_t k = 0; k < triangles.size(); ++k) {
    for (size_t i = 0; i < 3; ++i) {
      const int32_t from = triangles[k][i], to = triangles[k][(i + 1) % 3];
      triangles_[k].edges[i] = edge_normals.at(key(from, to)).normalized();
      triangles_[k].vertices[i] = vertex_normals[static_cast<size_t>(from)].normalized();
    }
  }
  nodes_.reserve(2 * triangles_.size());
  Build(0, static_cast<int32_t>(triangles_.size()));
}

int32_t SurfaceDistance::Build(int32_t begin, int32_t end) {
  const auto index = static_cast<int32_t>(nodes_.size());
  nodes_.emplace_back();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (int32_t k = begin; k < end; ++k) {
    for (const Eigen::Vector3d& corner : triangles_[static_cast<size_t>(k)].corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  int32_t right = -1;
  if (end - begin > kLeaf) {
    const int32_t middle = SplitInHalves(
        high - low, begin, end, triangles_,
        [](const Triangle& triangle) -> const auto& { return triangle.corners; });
    Build(begin, middle);
    right = Build(middle, end);
  }
  nodes_[static_cast<size_t>(index)] = {low, high, begin, end, right};
  return index;
}

// Source: Ericson, "Real-Time Collision Detection", 5.1.5: by the Voronoi regions of the triangle.
void SurfaceDistance::Test(const Triangle& triangle, const Eigen::Vector3d& point, Closest& best) {
  const auto& [a, b, c] = triangle.corners;
  const auto offer = [&](const Eigen::Vector3d& closest, const Eigen::Vector3d& normal,
                         double second, double third) {
    const double squared = (point - closest).squaredNorm();
    // Of triangles as near, as round a corner, the first: whatever else the surface has.
    const bool earlier =
        squared == best.squared && best.triangle != nullptr && triangle.id < best.triangle->id;
    if (squared < best.squared || earlier)
      best = {squared, closest, normal, &triangle, second, third};
  };
  const auto offer_corner = [&](size_t corner) {
    offer(triangle.corners[corner], triangle.vertices[corner], corner == 1 ? 1 : 0,
          corner == 2 ? 1 : 0);
  };
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = point - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return offer_corner(0);
  const Eigen::Vector3d bp = point - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return offer_corner(1);
  // Sides without length are closest nowhere.
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) {
    const double share = d1 / (d1 - d3);
    return offer(a + share * ab, triangle.edges[0], share, 0);
  }
  const Eigen::Vector3d cp = point - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return offer_corner(2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) {
    const double share = d2 / (d2 - d6);
    return offer(a + share * ac, triangle.edges[2], 0, share);
  }
  const double va = d3 * d6 - d5 * d4;
  const double past_b = d4 - d3, past_c = d5 - d6;
  if (va <= 0 && past_b >= 0 && past_c >= 0 && past_b + past_c > 0) {
    const double share = past_b / (past_b + past_c);
    return offer(b + share * (c - b), triangle.edges[1], 1 - share, share);
  }
  // Positive but for the rounding of triangles with hardly any area.
  const double of_b = std::max(vb, 0.0), of_c = std::max(vc, 0.0);
  const double sum = std::max(va, 0.0) + of_b + of_c;
  if (sum > 0)
    return offer(a + of_b / sum * ab + of_c / sum * ac, triangle.face, of_b / sum, of_c / sum);
  for (const size_t corner : {0, 1, 2}) offer_corner(corner);
}

void SurfaceDistance::Search(int32_t node, const Eigen::Vector3d& point, Closest& best) const {
  const Node& here = nodes_[static_cast<size_t>(node)];
  if (here.right < 0) {
    for (int32_t k = here.begin; k < here.end; ++k)
      Test(triangles_[static_cast<size_t>(k)], point, best);
    return;
  }
  int32_t near = node + 1, far = here.right;
  const auto squared = [&](int32_t child) {
    const Node& box = nodes_[static_cast<size_t>(child)];
    return SquaredDistanceToBox(box.low, box.high, point);
  };
  double near_squared = squared(near), far_squared = squared(far);
  if (far_squared < near_squared) {
    std::swap(near, far);
    std::swap(near_squared, far_squared);
  }
  if (near_squared <= best.squared) Search(near, point, best);
  if (far_squared <= best.squared) Search(far, point, best);
}

SignedDistance SurfaceDistance::At(const Eigen::Vector3d& point) const {
  Closest best{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(),
               Eigen::Vector3d::UnitZ()};
  Search(0, point, best);
  const Eigen::Vector3d away = point - best.point;
  const double length = std::sqrt(best.squared);
  const double sign = away.dot(best.normal) < 0 ? -1 : 1;
  // On the surface the direction to the closest point says nothing.
  const bool on_it = length <= 1e-12 * (nodes_[0].high - nodes_[0].low).norm();
  return {sign * length, on_it ? best.normal : Eigen::Vector3d(sign / length * away)};
}

SurfacePoint SurfaceDistance::ClosestPoint(const Eigen::Vector3d& point) const {
  Closest best{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(),
               Eigen::Vector3d::UnitZ()};
  Search(0, point, best);
  return {best.triangle->id,
          {1 - best.second - best.third, best.second, best.third},
          std::sqrt(best.squared)};
}

bool SurfaceReaches(const std::vector<Vec3>& vertices,
                    const std::vector<std::array<int32_t, 3>>& triangles, double reach,
                    const std::vector<Vec3>& points) {
  const SurfaceDistance surface(vertices, triangles);
  return std::any_of(points.begin(), points.end(), [&](const Vec3& point) {
    return surface.ClosestPoint(Eigen::Vector3d(point[0], point[1], point[2])).distance <= reach;
  });
}

}  // namespace cleave
