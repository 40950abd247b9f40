#include "core/impurity/fields.h"

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "core/base/counter_rng.h"
#include "core/base/parallel.h"
#include "core/impurity/falloff.h"
#include "core/impurity/impurity_noise.h"
#include "core/scene/impurity_places.h"

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

std::vector<double> SharesAt(std::vector<double> distances, const ImpurityLayer& layer) {
  for (double& value : distances) value = ShareAt(value, layer);
  return distances;
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
  return SharesAt(DistancesOutside(field, mesh), layer);
}

std::vector<double> PocketShares(const PocketField& field, const ImpurityLayer& layer,
                                 uint64_t seed, const TetMesh& mesh) {
  return SharesAt(DistancesOutside(field, layer.falloff, seed, mesh), layer);
}

}  // namespace cleave
