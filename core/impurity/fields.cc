#include "core/impurity/fields.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/counter_rng.h"
#include "core/base/parallel.h"
#include "core/impurity/falloff.h"
#include "core/impurity/impurity_noise.h"
#include "core/mesh/plane_grid.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

constexpr int64_t kGrain = 256;  // nodes a task
constexpr size_t kWaves = 256;

struct Wave {
  Vector3d number;  // rad/m
  double phase;     // rad
};

std::vector<Wave> DrawWaves(double correlation_length, uint64_t seed) {
  std::vector<Wave> waves(kWaves);
  for (size_t k = 0; k < kWaves; ++k) {
    const auto draw = [&](uint64_t subindex) {
      return UniformDraw(seed, RandomStream::kNoiseWave, k, subindex);
    };
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto at = static_cast<uint64_t>(2 * i);
      const double normal =
          std::sqrt(-2 * std::log(draw(at))) * std::cos(2 * std::numbers::pi * draw(at + 1));
      waves[k].number[i] = normal / correlation_length;
    }
    waves[k].phase = 2 * std::numbers::pi * draw(6);
  }
  return waves;
}

// Evenly spread over the volume of the mesh.
std::vector<Vector3d> DrawPoints(int32_t count, uint64_t seed, const TetMesh& mesh) {
  std::vector<double> ends;  // of the tets, laid end to end by volume
  ends.reserve(mesh.tets.size());
  double volume = 0;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    volume += SignedVolume(CornersOf(mesh, tet));
    ends.push_back(volume);
  }
  std::vector<Vector3d> points;
  for (int32_t k = 0; k < count; ++k) {
    const auto draw = [&](uint64_t subindex) {
      return UniformDraw(seed, RandomStream::kPocket, static_cast<uint64_t>(k), subindex);
    };
    const auto found = std::upper_bound(ends.begin(), ends.end(), draw(0) * volume);
    const auto tet = std::min(static_cast<size_t>(found - ends.begin()), ends.size() - 1);
    // The gaps between three sorted numbers are even over the tet.
    std::array<double, 3> cuts = {draw(1), draw(2), draw(3)};
    std::sort(cuts.begin(), cuts.end());
    const std::array<double, 4> weights = {cuts[0], cuts[1] - cuts[0], cuts[2] - cuts[1],
                                           1 - cuts[2]};
    Vector3d& point = points.emplace_back(Vector3d::Zero());
    for (size_t i = 0; i < 4; ++i) {
      const auto node = static_cast<size_t>(mesh.tets[tet][i]);
      point += weights[i] * Vector3d(mesh.rest_positions[node].data());
    }
  }
  return points;
}

}  // namespace

std::vector<double> NoiseValues(const NoiseField& field, uint64_t seed, const TetMesh& mesh) {
  std::vector<double> values(mesh.rest_positions.size());
  if (field.correlation_length == 0) {
    for (size_t node = 0; node < values.size(); ++node)
      values[node] = NodeNoise(seed, static_cast<int32_t>(node), field.distribution);
    return values;
  }
  const std::vector<Wave> waves = DrawWaves(field.correlation_length, seed);
  const double amplitude = std::sqrt(2.0 / kWaves);
  ParallelFor(mesh.node_count(), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t n = begin; n < end; ++n) {
      const auto node = static_cast<size_t>(n);
      const Vector3d at(mesh.rest_positions[node].data());
      double sum = 0;
      for (const Wave& wave : waves) sum += std::cos(wave.number.dot(at) + wave.phase);
      const double normal = amplitude * sum;
      values[node] = field.distribution == NoiseDistribution::kGaussian
                         ? normal
                         : std::sqrt(3.0) * (std::erfc(-normal / std::numbers::sqrt2) - 1);
    }
  });
  return values;
}

std::vector<double> BandShares(const BandField& field, const ImpurityLayer& layer,
                               const TetMesh& mesh) {
  const Vector3d center(field.center.data());
  const Vector3d axis = Vector3d(field.axis.data()).stableNormalized();
  std::vector<double> shares;
  shares.reserve(mesh.rest_positions.size());
  for (const Vec3& position : mesh.rest_positions) {
    const Vector3d arm = Vector3d(position.data()) - center;
    double place = arm.norm();  // across the bands
    if (field.shape == BandShape::kPlanes) place = arm.dot(axis);
    if (field.shape == BandShape::kCylinders) place = (arm - arm.dot(axis) * axis).norm();
    double off = place - field.position;
    if (field.spacing) off -= *field.spacing * std::round(off / *field.spacing);
    shares.push_back(ShareAt(std::abs(off) - field.width / 2, layer));
  }
  return shares;
}

std::vector<double> PocketShares(const PocketField& field, const ImpurityLayer& layer,
                                 uint64_t seed, const TetMesh& mesh) {
  const std::vector<Vector3d> centers = DrawPoints(field.count, seed, mesh);
  std::vector<PlaneBox> boxes;
  for (const Vector3d& center : centers) {
    boxes.push_back({{center[0], center[1]}, {center[0], center[1]}});
    boxes.back().Grow(field.radius + layer.falloff);
  }
  const PlaneGrid grid(boxes);
  std::vector<double> shares(mesh.rest_positions.size(), 0);
  ParallelFor(mesh.node_count(), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t n = begin; n < end; ++n) {
      const auto node = static_cast<size_t>(n);
      const Vector3d at(mesh.rest_positions[node].data());
      grid.Near({{at[0], at[1]}, {at[0], at[1]}}, [&](int32_t pocket) {
        const double outside = (at - centers[static_cast<size_t>(pocket)]).norm() - field.radius;
        shares[node] = std::max(shares[node], ShareAt(outside, layer));
      });
    }
  });
  return shares;
}

}  // namespace cleave
