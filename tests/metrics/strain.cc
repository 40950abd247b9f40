#include "tests/metrics/strain.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace cleave {
namespace {

Eigen::Vector3d At(const std::vector<Vec3>& positions, int32_t node) {
  return Eigen::Vector3d(positions[static_cast<size_t>(node)].data());
}

Eigen::Matrix3d Edges(const std::vector<Vec3>& positions, const std::array<int32_t, 4>& tet) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k)
    edges.col(k) = At(positions, tet[static_cast<size_t>(k) + 1]) - At(positions, tet[0]);
  return edges;
}

}  // namespace

double PrincipalStrain(const TetMesh& mesh, int32_t tet, const Frame& frame) {
  const auto& nodes = mesh.tets[static_cast<size_t>(tet)];
  const Eigen::Matrix3d gradient =
      Edges(frame.positions, nodes) * Edges(mesh.rest_positions, nodes).inverse();
  return gradient.jacobiSvd().singularValues()[0] - 1;
}

double StrainToFirstCrack(const TetMesh& mesh, const Incidence& incidence,
                          std::span<const Frame> frames) {
  size_t last = 0;
  while (last + 1 < frames.size() && frames[last + 1].broken_edges.empty()) ++last;
  if (last + 1 >= frames.size() || !frames[last].broken_edges.empty()) return -1;
  int32_t worst = 0;
  double largest = -1;
  for (int32_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const double strain = PrincipalStrain(mesh, tet, frames[last]);
    if (strain > largest) {
      largest = strain;
      worst = tet;
    }
  }
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const int32_t node : mesh.tets[static_cast<size_t>(worst)])
    center += At(mesh.rest_positions, node) / 4;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int32_t edge : frames[last + 1].broken_edges) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    const Eigen::Vector3d middle = (At(mesh.rest_positions, a) + At(mesh.rest_positions, b)) / 2;
    nearest = std::min(nearest, (middle - center).norm());
  }
  return nearest;
}

}  // namespace cleave
