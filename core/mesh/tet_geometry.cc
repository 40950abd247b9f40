#include "core/mesh/tet_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cleave {
namespace {

// Outward area vectors of the faces of a tet of positive volume, twice the area long.
std::array<Eigen::Vector3d, 4> FaceVectors(const TetCorners& corners) {
  std::array<Eigen::Vector3d, 4> vectors;
  for (size_t face = 0; face < 4; ++face) {
    const auto& [a, b, c] = kTetFaces[face];
    const Eigen::Vector3d& first = corners[static_cast<size_t>(a)];
    vectors[face] =
        (corners[static_cast<size_t>(b)] - first).cross(corners[static_cast<size_t>(c)] - first);
  }
  return vectors;
}

}  // namespace

TetCorners CornersOf(const TetMesh& mesh, int64_t tet) {
  TetCorners corners;
  for (size_t k = 0; k < 4; ++k) {
    const auto node = static_cast<size_t>(mesh.tets[static_cast<size_t>(tet)][k]);
    corners[k] = Eigen::Map<const Eigen::Vector3d>(mesh.rest_positions[node].data());
  }
  return corners;
}

double SignedVolume(const TetCorners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]) / 6;
}

std::array<double, 2> EdgeRange(const TetCorners& corners) {
  double shortest = std::numeric_limits<double>::infinity();
  double longest = 0;
  for (const auto& [a, b] : kTetEdges) {
    const double length =
        (corners[static_cast<size_t>(a)] - corners[static_cast<size_t>(b)]).squaredNorm();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  return {std::sqrt(shortest), std::sqrt(longest)};
}

double Aspect(const TetCorners& corners) {
  double doubled_area = 0;
  for (const Eigen::Vector3d& vector : FaceVectors(corners)) doubled_area += vector.norm();
  // Inscribed radius: three volumes over the surface.
  const double radius = 6 * std::abs(SignedVolume(corners)) / doubled_area;
  const double aspect = EdgeRange(corners)[1] / (2 * std::sqrt(6.0) * radius);
  return std::isfinite(aspect) ? aspect : std::numeric_limits<double>::infinity();
}

std::array<double, 2> DihedralRange(const TetCorners& corners) {
  const std::array<Eigen::Vector3d, 4> vectors = FaceVectors(corners);
  double smallest = std::numbers::pi;
  double largest = 0;
  for (const auto& [a, b] : kTetEdges) {
    const Eigen::Vector3d& u = vectors[static_cast<size_t>(a)];
    const Eigen::Vector3d& v = vectors[static_cast<size_t>(b)];
    const double angle = std::numbers::pi - std::atan2(u.cross(v).norm(), u.dot(v));
    smallest = std::min(smallest, angle);
    largest = std::max(largest, angle);
  }
  return {smallest, largest};
}

}  // namespace cleave
