#include "core/scene/impurity_places.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/counter_rng.h"
#include "core/base/parallel.h"
#include "core/mesh/plane_grid.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

constexpr int64_t kGrain = 256;  // nodes a task

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

uint64_t LayerSeed(const Scene& scene, size_t layer) {
  const std::optional<uint32_t>& own = scene.impurities->layers[layer].seed;
  return own ? (uint64_t{1} << 32) + *own : ((uint64_t{2} + layer) << 32) + scene.seed;
}

std::vector<double> DistancesOutside(const BandField& bands, const TetMesh& mesh) {
  const Vector3d center(bands.center.data());
  const Vector3d axis = Vector3d(bands.axis.data()).stableNormalized();
  std::vector<double> distances;
  distances.reserve(mesh.rest_positions.size());
  for (const Vec3& position : mesh.rest_positions) {
    const Vector3d arm = Vector3d(position.data()) - center;
    double place = arm.norm();  // across the bands
    if (bands.shape == BandShape::kPlanes) place = arm.dot(axis);
    if (bands.shape == BandShape::kCylinders) place = (arm - arm.dot(axis) * axis).norm();
    double off = place - bands.position;
    if (bands.spacing) off -= *bands.spacing * std::round(off / *bands.spacing);
    distances.push_back(std::abs(off) - bands.width / 2);
  }
  return distances;
}

std::vector<double> DistancesOutside(const PocketField& pockets, double reach, uint64_t seed,
                                     const TetMesh& mesh) {
  const std::vector<Vector3d> centers = DrawPoints(pockets.count, seed, mesh);
  std::vector<PlaneBox> boxes;
  for (const Vector3d& center : centers) {
    boxes.push_back({{center[0], center[1]}, {center[0], center[1]}});
    boxes.back().Grow(pockets.radius + reach);
  }
  const PlaneGrid grid(boxes);
  std::vector<double> distances(mesh.rest_positions.size(),
                                std::numeric_limits<double>::infinity());
  ParallelFor(mesh.node_count(), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t n = begin; n < end; ++n) {
      const auto node = static_cast<size_t>(n);
      const Vector3d at(mesh.rest_positions[node].data());
      grid.Near({{at[0], at[1]}, {at[0], at[1]}}, [&](int32_t pocket) {
        if (distances[node] <= 0) return;  // how deep inside it is does not matter
        const double outside = (at - centers[static_cast<size_t>(pocket)]).norm() - pockets.radius;
        distances[node] = std::min(distances[node], outside);
      });
    }
  });
  return distances;
}

}  // namespace cleave
