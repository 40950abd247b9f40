#include "core/surface/point_motion.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <optional>

#include "core/base/parallel.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int64_t kGrain = 512;
constexpr double kMinStretch = 0.2;
constexpr double kMaxStretch = 5;

Vector3d At(std::span<const Vec3> positions, int32_t node) {
  return Vector3d(positions[static_cast<size_t>(node)].data());
}

bool IsInterpolated(const SurfacePoint& point) { return point.owned_by_all() && !point.off_nodes; }

Matrix3d EdgeMatrix(const std::array<int32_t, 4>& nodes, std::span<const Vec3> positions) {
  const Vector3d origin = At(positions, nodes[0]);
  Matrix3d edges;
  edges << At(positions, nodes[1]) - origin, At(positions, nodes[2]) - origin,
      At(positions, nodes[3]) - origin;
  return edges;
}

using Svd = Eigen::JacobiSVD<Matrix3d>;

// With singular values outside of the allowed stretch moved to its ends.
Matrix3d Clamped(const Matrix3d& gradient) {
  const Svd svd(gradient, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success) return gradient;  // not finite
  const Vector3d values = svd.singularValues();
  if (values.minCoeff() >= kMinStretch && values.maxCoeff() <= kMaxStretch) return gradient;
  return svd.matrixU() * values.cwiseMax(kMinStretch).cwiseMin(kMaxStretch).asDiagonal() *
         svd.matrixV().transpose();
}

// The nearest rotation.
Matrix3d Turn(const Matrix3d& gradient) {
  const Svd svd(gradient, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success) return Matrix3d::Identity();  // not finite
  Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

// The volume-weighted mean deformation gradient of some tets, without those whose vertices are
// separated if `masks` are given; nothing when no tet counts.
std::optional<Matrix3d> MeanGradient(const TetMesh& mesh, std::span<const int32_t> tets,
                                     std::span<const EdgeMask> masks,
                                     std::span<const Vec3> positions) {
  Matrix3d sum = Matrix3d::Zero();  // 6 V F
  double six_volumes = 0;
  for (const int32_t tet : tets) {
    const auto t = static_cast<size_t>(tet);
    if (!masks.empty() && Separated(masks[t])) continue;
    const Matrix3d rest = EdgeMatrix(mesh.tets[t], mesh.rest_positions);
    Matrix3d cofactor;
    cofactor << rest.col(1).cross(rest.col(2)), rest.col(2).cross(rest.col(0)),
        rest.col(0).cross(rest.col(1));
    sum += EdgeMatrix(mesh.tets[t], positions) * cofactor.transpose();
    six_volumes += cofactor.col(0).dot(rest.col(0));
  }
  if (!(six_volumes > 0)) return std::nullopt;
  return sum / six_volumes;
}

}  // namespace

PointMotion::PointMotion(const TetMesh& mesh, const Incidence& incidence)
    : mesh_(mesh),
      incidence_(incidence),
      gradients_(mesh.rest_positions.size()),
      has_gradient_(mesh.rest_positions.size(), 0) {}

void PointMotion::UpdateGradients(const SurfaceTopology& surface, std::span<const Vec3> positions) {
  owner_nodes_.clear();
  for (const SurfacePoint& point : surface.points) {
    if (IsInterpolated(point)) continue;
    for (size_t i = 0; i < point.node_count; ++i) {
      if ((point.owners >> i & 1) != 0) owner_nodes_.push_back(point.nodes[i]);
    }
  }
  std::sort(owner_nodes_.begin(), owner_nodes_.end());
  owner_nodes_.erase(std::unique(owner_nodes_.begin(), owner_nodes_.end()), owner_nodes_.end());
  ParallelFor(static_cast<int64_t>(owner_nodes_.size()), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      const int32_t node = owner_nodes_[static_cast<size_t>(i)];
      const std::span<const int32_t> tets = incidence_.node_tets[node];
      std::optional<Matrix3d> mean = MeanGradient(mesh_, tets, surface.tet_masks, positions);
      uint8_t& has_gradient = has_gradient_[static_cast<size_t>(node)];
      if (mean) {
        mean = Clamped(*mean);
      } else if (has_gradient == 0) {
        mean = MeanGradient(mesh_, tets, {}, positions);
        if (mean) mean = Turn(*mean);
      }
      if (!mean) continue;
      Eigen::Map<Matrix3d>(gradients_[static_cast<size_t>(node)].data()) = *mean;
      has_gradient = 1;
    }
  });
}

void PointMotion::Move(const SurfaceTopology& surface, std::span<const Vec3> positions,
                       std::vector<Vec3>& points) {
  UpdateGradients(surface, positions);
  points.resize(surface.points.size());
  ParallelFor(static_cast<int64_t>(points.size()), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t p = begin; p < end; ++p) {
      const SurfacePoint& point = surface.points[static_cast<size_t>(p)];
      Eigen::Map<Vector3d> moved(points[static_cast<size_t>(p)].data());
      moved.setZero();
      if (IsInterpolated(point)) {
        for (size_t i = 0; i < point.node_count; ++i)
          moved += point.weights[i] * At(positions, point.nodes[i]);
        continue;
      }
      int owners = 0;
      for (size_t i = 0; i < point.node_count; ++i) {
        if ((point.owners >> i & 1) == 0) continue;
        const int32_t node = point.nodes[i];
        const Eigen::Map<const Matrix3d> gradient(gradients_[static_cast<size_t>(node)].data());
        moved += At(positions, node) +
                 gradient * (Vector3d(point.rest.data()) - At(mesh_.rest_positions, node));
        ++owners;
      }
      moved /= owners;
    }
  });
}

}  // namespace cleave
