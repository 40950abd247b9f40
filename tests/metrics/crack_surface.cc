#include "tests/metrics/crack_surface.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/damage/edge_mask.h"
#include "tests/metrics/pieces.h"
#include "tests/metrics/statistics.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

Vector3d Load(const Vec3& v) { return {v[0], v[1], v[2]}; }
Vec3 Store(const Vector3d& v) { return {v[0], v[1], v[2]}; }

// The polygon that parts the vertices of `inside` from the others.
CrackFacet FacetRound(const std::array<Vector3d, 4>& corners, const std::array<bool, 4>& inside,
                      int32_t tet) {
  std::array<int, 4> in{}, out{};
  int in_count = 0, out_count = 0;
  for (int v = 0; v < 4; ++v) {
    (inside[static_cast<size_t>(v)] ? in[static_cast<size_t>(in_count++)]
                                    : out[static_cast<size_t>(out_count++)]) = v;
  }
  const auto middle = [&](int a, int b) {
    return Vector3d((corners[static_cast<size_t>(a)] + corners[static_cast<size_t>(b)]) / 2);
  };
  Vector3d center, area;
  if (in_count == 2) {
    const Vector3d p = middle(in[0], out[0]), q = middle(in[0], out[1]);
    const Vector3d r = middle(in[1], out[1]), s = middle(in[1], out[0]);
    center = (p + q + r + s) / 4;
    area = (r - p).cross(s - q) / 2;
  } else {
    const int apex = in_count == 1 ? in[0] : out[0];
    const std::array<int, 4>& rest = in_count == 1 ? out : in;
    const Vector3d p = middle(apex, rest[0]), q = middle(apex, rest[1]), r = middle(apex, rest[2]);
    center = (p + q + r) / 3;
    area = (q - p).cross(r - p) / 2;
  }
  const double size = area.norm();
  return {Store(center), Store(area / size), size / 2, tet, 0};
}

}  // namespace

std::vector<CrackFacet> CrackSurface(const TetMesh& mesh, const Incidence& incidence,
                                     std::span<const int32_t> broken_edges) {
  const std::vector<EdgeMask> masks = TetEdgeMasks(incidence, broken_edges);
  std::vector<CrackFacet> crack;
  for (size_t tet = 0; tet < masks.size(); ++tet) {
    const VertexGroups& groups = kVertexGroups[masks[tet]];
    if (groups.count == 1) continue;
    std::array<Vector3d, 4> corners;
    for (size_t v = 0; v < 4; ++v)
      corners[v] = Load(mesh.rest_positions[static_cast<size_t>(mesh.tets[tet][v])]);
    for (int8_t leader = 0; leader < 4; ++leader) {
      if (groups.group[static_cast<size_t>(leader)] != leader) continue;
      std::array<bool, 4> inside{};
      for (size_t v = 0; v < 4; ++v) inside[v] = groups.group[v] == leader;
      CrackFacet facet = FacetRound(corners, inside, static_cast<int32_t>(tet));
      facet.node = mesh.tets[tet][static_cast<size_t>(leader)];
      crack.push_back(facet);
    }
  }
  return crack;
}

std::vector<CrackFacet> CrackOfPieces(const TetMesh& mesh, const Incidence& incidence,
                                      std::span<const int32_t> broken_edges) {
  const Pieces pieces = PiecesOf(mesh, incidence, broken_edges);
  std::vector<CrackFacet> crack = CrackSurface(mesh, incidence, broken_edges);
  std::erase_if(crack, [&](const CrackFacet& facet) {
    return pieces.node_pieces[static_cast<size_t>(facet.node)] < 0;
  });
  return crack;
}

std::vector<CrackFacet> SmoothedCrack(std::span<const CrackFacet> crack, double radius) {
  std::vector<CrackFacet> smooth(crack.begin(), crack.end());
  for (CrackFacet& facet : smooth) {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (const CrackFacet& other : crack) {
      if ((Load(other.center) - Load(facet.center)).squaredNorm() > radius * radius) continue;
      moment += other.area * Load(other.normal) * Load(other.normal).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
    facet.normal = Store(solver.eigenvectors().col(2));
  }
  return smooth;
}

std::vector<std::vector<CrackFacet>> CrackParts(std::span<const CrackFacet> crack, double reach) {
  std::vector<std::vector<CrackFacet>> parts;
  std::vector<uint8_t> taken(crack.size(), 0);
  for (size_t first = 0; first < crack.size(); ++first) {
    if (taken[first] != 0) continue;
    taken[first] = 1;
    std::vector<CrackFacet> part = {crack[first]};
    for (size_t next = 0; next < part.size(); ++next) {
      for (size_t other = 0; other < crack.size(); ++other) {
        if (taken[other] != 0) continue;
        const Vector3d away = Load(crack[other].center) - Load(part[next].center);
        if (away.squaredNorm() > reach * reach) continue;
        taken[other] = 1;
        part.push_back(crack[other]);
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

double CrackArea(std::span<const CrackFacet> crack) {
  double area = 0;
  for (const CrackFacet& facet : crack) area += facet.area;
  return area;
}

double FibreCrossing(std::span<const CrackFacet> crack,
                     const std::function<Vec3(int32_t tet)>& direction) {
  const double area = CrackArea(crack);
  double sum = 0;
  for (const CrackFacet& facet : crack)
    sum += facet.area * std::abs(Load(facet.normal).dot(Load(direction(facet.tet))));
  return area > 0 ? sum / area : 0;
}

double FibreCrossing(std::span<const CrackFacet> crack, const Vec3& direction) {
  return FibreCrossing(crack, [&](int32_t) { return direction; });
}

Vec3 CrackCenter(std::span<const CrackFacet> crack) {
  const double area = CrackArea(crack);
  Vector3d sum = Vector3d::Zero();
  for (const CrackFacet& facet : crack) sum += facet.area * Load(facet.center);
  return area > 0 ? Store(sum / area) : Vec3{0, 0, 0};
}

double DistanceFromPlane(std::span<const CrackFacet> crack, const Vec3& point, const Vec3& normal,
                         double share) {
  const Vector3d n = Load(normal).normalized();
  std::vector<double> distances, areas;
  for (const CrackFacet& facet : crack) {
    distances.push_back(std::abs((Load(facet.center) - Load(point)).dot(n)));
    areas.push_back(facet.area);
  }
  return Percentile(distances, share, areas);
}

CrackExtent ExtentAlong(std::span<const CrackFacet> crack, const Vec3& axis, double tail) {
  std::vector<double> places, areas;
  for (const CrackFacet& facet : crack) {
    places.push_back(Load(facet.center).dot(Load(axis)));
    areas.push_back(facet.area);
  }
  return {Percentile(places, tail, areas), Percentile(places, 1 - tail, areas)};
}

std::vector<Vec3> TraceDirections(std::span<const CrackFacet> crack, const Vec3& normal,
                                  double radius) {
  const Vector3d n = Load(normal).normalized();
  const Vector3d u = n.unitOrthogonal();
  const Vector3d v = n.cross(u);
  std::vector<Vec3> directions;
  for (const CrackFacet& facet : crack) {
    // Moments of the surroundings in the plane.
    double area = 0;
    int count = 0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
    for (const CrackFacet& other : crack) {
      const Vector3d away = Load(other.center) - Load(facet.center);
      const Eigen::Vector2d place(away.dot(u), away.dot(v));
      if (place.squaredNorm() > radius * radius) continue;
      ++count;
      area += other.area;
      mean += other.area * place;
      moment += other.area * place * place.transpose();
    }
    if (count < 3) {
      directions.push_back({0, 0, 0});
      continue;
    }
    mean /= area;
    moment = moment / area - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(moment);
    const Eigen::Vector2d along = solver.eigenvectors().col(1);
    directions.push_back(Store(along[0] * u + along[1] * v));
  }
  return directions;
}

double TraceAngle(std::span<const CrackFacet> crack, const Vec3& normal, double radius,
                  const Vec3& direction) {
  const std::vector<Vec3> trace = TraceDirections(crack, normal, radius);
  std::vector<double> angles, areas;
  for (size_t i = 0; i < trace.size(); ++i) {
    const Vector3d along = Load(trace[i]);
    if (along.isZero()) continue;
    const double cosine = std::min(1.0, std::abs(along.dot(Load(direction).normalized())));
    angles.push_back(std::acos(cosine) * 180 / std::numbers::pi);
    areas.push_back(crack[i].area);
  }
  return angles.empty() ? 90 : Percentile(angles, 0.5, areas);
}

}  // namespace cleave
