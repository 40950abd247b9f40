#include "core/material/fibre_directions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <variant>

#include "core/base/parallel.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

Vector3d ToVector(const Vec3& v) { return Vector3d(v.data()); }

// Scaled first, so that no length under- or overflows.
Vector3d Normalised(const Vector3d& v) { return (v / v.cwiseAbs().maxCoeff()).normalized(); }

Vector3d Centroid(const TetMesh& mesh, int32_t tet) {
  Vector3d sum = Vector3d::Zero();
  for (const int32_t node : mesh.tets[static_cast<size_t>(tet)])
    sum += ToVector(mesh.rest_positions[static_cast<size_t>(node)]);
  return sum / 4;
}

struct DirectionAt {
  Vector3d point;

  std::optional<Vector3d> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Vector3d> operator()(const TetDirections&) const { return std::nullopt; }
  std::optional<Vector3d> operator()(const ConstantDirection& constant) const {
    return Normalised(ToVector(constant.vector));
  }
  std::optional<Vector3d> operator()(const CylindricalDirection& frame) const {
    const Vector3d axis = Normalised(ToVector(frame.axis));
    const Vector3d arm = point - ToVector(frame.center);
    const Vector3d outward = arm - axis.dot(arm) * axis;
    const bool on_axis = !(outward.norm() > 1e-12 * arm.norm());
    const Vector3d out = on_axis ? axis.unitOrthogonal() : Normalised(outward);
    const Vector3d mixture = Normalised(ToVector(frame.mixture));
    return mixture[0] * out + mixture[1] * axis.cross(out) + mixture[2] * axis;
  }
  // Tangents have no sign, so their dyads are averaged and the strongest direction is taken.
  std::optional<Vector3d> operator()(const CurveDirections& directions) const {
    double nearest = INFINITY;  // squared
    ForEachSegment(directions, point, [&](const Vector3d&, double squared, double) {
      nearest = std::min(nearest, squared);
    });
    Eigen::Matrix3d dyads = Eigen::Matrix3d::Zero();
    ForEachSegment(directions, point, [&](const Vector3d& tangent, double squared, double length) {
      // Relative to the nearest, so that weights are finite on a curve too.
      const double closeness = squared > 0 ? nearest / squared : 1;
      dyads += length * closeness * closeness * tangent * tangent.transpose();
    });
    return Vector3d(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(dyads).eigenvectors().col(2));
  }

  // visit(unit tangent, squared distance of `at`, length of the segment)
  template <typename Visit>
  static void ForEachSegment(const CurveDirections& directions, const Vector3d& at,
                             const Visit& visit) {
    for (const Polyline& curve : directions.curves) {
      for (size_t k = 1; k < curve.points.size(); ++k) {
        const Vector3d begin = ToVector(curve.points[k - 1]);
        const Vector3d along = ToVector(curve.points[k]) - begin;
        const double length = along.norm();
        if (length == 0) continue;
        const Vector3d tangent = along / length;
        const double share = std::clamp(tangent.dot(at - begin), 0.0, length);
        visit(tangent, (at - begin - share * tangent).squaredNorm(), length);
      }
    }
  }
};

}  // namespace

std::vector<Vec3> FibreDirections(const FibreDirection& direction, const TetMesh& mesh,
                                  std::span<const int32_t> tets) {
  std::vector<Vec3> directions(tets.size());
  const auto* per_tet = std::get_if<TetDirections>(&direction);
  ParallelFor(static_cast<int64_t>(tets.size()), 256, [&](int64_t begin, int64_t end) {
    for (auto k = static_cast<size_t>(begin); k < static_cast<size_t>(end); ++k) {
      const Vector3d unit =
          per_tet != nullptr ? Normalised(ToVector(per_tet->vectors[static_cast<size_t>(tets[k])]))
                             : std::visit(DirectionAt{Centroid(mesh, tets[k])}, direction)
                                   .value_or(Vector3d::UnitX());
      directions[k] = {unit[0], unit[1], unit[2]};
    }
  });
  return directions;
}

std::optional<Vec3> FibreDirectionAt(const FibreDirection& direction, const Vec3& point) {
  const std::optional<Vector3d> unit = std::visit(DirectionAt{ToVector(point)}, direction);
  if (!unit.has_value()) return std::nullopt;
  return Vec3{(*unit)[0], (*unit)[1], (*unit)[2]};
}

}  // namespace cleave
