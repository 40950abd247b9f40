#include "core/model/tet_batches.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/base/parallel.h"

namespace cleave {
namespace {

Eigen::Matrix3d RestEdges(const TetMesh& mesh, const std::array<int32_t, 4>& tet) {
  const auto at = [&](size_t vertex) {
    return Eigen::Map<const Eigen::Vector3d>(
        mesh.rest_positions[static_cast<size_t>(tet[vertex])].data());
  };
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = at(static_cast<size_t>(k) + 1) - at(0);
  return edges;
}

}  // namespace

double RestVolume(const TetMesh& mesh, int64_t tet) {
  auto nodes = mesh.tets[static_cast<size_t>(tet)];
  std::sort(nodes.begin(), nodes.end());
  return std::abs(RestEdges(mesh, nodes).determinant()) / 6;
}

template <typename T>
int64_t TetBatches<T>::place_of(int64_t tet) const {
  if (tets.empty()) return tet;
  const auto found = std::lower_bound(tets.begin(), tets.end(), tet);
  return found != tets.end() && *found == tet ? found - tets.begin() : -1;
}

template <typename T>
TetBatches<T> BuildTetBatches(const TetMesh& mesh, const Incidence& incidence,
                              std::vector<int32_t> tets) {
  constexpr int64_t kLanes = TetBatches<T>::kLanes;
  constexpr int64_t kChunk = TetBatches<T>::kChunkBatches * kLanes;
  TetBatches<T> result;
  result.tets = std::move(tets);
  result.tet_count =
      result.tets.empty() ? mesh.tet_count() : static_cast<int64_t>(result.tets.size());
  result.batches.resize(static_cast<size_t>((result.tet_count + kLanes - 1) / kLanes));
  if (result.tets.empty()) {
    result.coloring = ColorChunks(mesh.tets, mesh.node_count(), kChunk);
  } else {
    std::vector<std::array<int32_t, 4>> chosen;
    for (const int32_t tet : result.tets) chosen.push_back(mesh.tets[static_cast<size_t>(tet)]);
    result.coloring = ColorChunks(chosen, mesh.node_count(), kChunk);
  }
  if constexpr (std::is_same_v<T, Float8>) {
    double volume = 0;
    for (int64_t place = 0; place < result.tet_count; ++place)
      volume += RestVolume(mesh, result.tet_at(place));
    result.length_unit =
        std::exp2(std::ilogb(std::cbrt(volume / static_cast<double>(result.tet_count))));
  }
  const double length_unit = result.length_unit;
  using Scalar = typename Lanes<T>::Scalar;
  ParallelFor(result.batch_count(), 256, [&](int64_t begin, int64_t end) {
    for (int64_t b = begin; b < end; ++b) {
      TetBatch<T>& batch = result.batches[static_cast<size_t>(b)];
      for (size_t lane = 0; lane < kLanes; ++lane) {
        // Lanes past the last tet repeat it with no volume.
        const int64_t place = b * kLanes + static_cast<int64_t>(lane);
        const int64_t tet = result.tet_at(std::min(place, result.tet_count - 1));
        auto nodes = mesh.tets[static_cast<size_t>(tet)];
        std::sort(nodes.begin(), nodes.end());
        for (size_t vertex = 0; vertex < 4; ++vertex) batch.nodes[vertex][lane] = nodes[vertex];
        for (const int32_t edge : incidence.tet_edges[static_cast<size_t>(tet)]) {
          const auto& ends = incidence.edges[static_cast<size_t>(edge)];
          for (size_t k = 0; k < 6; ++k) {
            if (ends[0] == nodes[static_cast<size_t>(kTetEdges[k][0])] &&
                ends[1] == nodes[static_cast<size_t>(kTetEdges[k][1])])
              batch.edges[k][lane] = edge;
          }
        }
        const Eigen::Matrix3d inverse = RestEdges(mesh, nodes).inverse() * length_unit;
        for (int vertex = 0; vertex < 3; ++vertex) {
          for (int axis = 0; axis < 3; ++axis)
            batch.gradient(vertex, axis)[lane] = static_cast<Scalar>(inverse(vertex, axis));
        }
        const double volume = place < result.tet_count ? RestVolume(mesh, tet) : 0;
        batch.volume[lane] = static_cast<Scalar>(volume / std::pow(length_unit, 3));
      }
    }
  });
  return result;
}

template <typename T>
void KeepAwake(TetBatches<T>& tets, std::span<uint8_t> asleep) {
  tets.kept.reset();
  if (asleep.empty()) return;
  const auto is_awake = [&](int64_t batch) {
    for (int lane = 0; lane < tets.lanes(batch); ++lane) {
      if (asleep[static_cast<size_t>(tets.tet_at(batch * TetBatches<T>::kLanes + lane))] == 0)
        return true;
    }
    return false;
  };
  BatchRuns kept;
  for (const std::vector<int32_t>& color : tets.coloring.colors) {
    std::vector<std::array<int32_t, 2>>& chunks = kept.colors.emplace_back();
    for (const int32_t chunk : color) {
      const int64_t first = chunk * TetBatches<T>::kChunkBatches;
      const int64_t last = std::min(first + TetBatches<T>::kChunkBatches, tets.batch_count());
      const auto first_run = static_cast<int32_t>(kept.runs.size());
      bool runs_on = false;
      for (int64_t batch = first; batch < last; ++batch) {
        if (!is_awake(batch)) {
          runs_on = false;
          continue;
        }
        for (int lane = 0; lane < tets.lanes(batch); ++lane)
          asleep[static_cast<size_t>(tets.tet_at(batch * TetBatches<T>::kLanes + lane))] = 0;
        if (!runs_on) kept.runs.push_back({batch, batch});
        runs_on = true;
        kept.runs.back()[1] = batch + 1;
      }
      const auto end_run = static_cast<int32_t>(kept.runs.size());
      if (end_run > first_run) chunks.push_back({first_run, end_run});
    }
  }
  tets.kept = std::move(kept);
}

template <typename T>
void ForEachChunk(const TetBatches<T>& tets,
                  absl::FunctionRef<void(int64_t, int64_t, int64_t)> body) {
  if (tets.kept) {
    for (const std::vector<std::array<int32_t, 2>>& color : tets.kept->colors) {
      ParallelFor(static_cast<int64_t>(color.size()), 1, [&](int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
          const auto [first_run, end_run] = color[static_cast<size_t>(k)];
          for (int64_t run = first_run; run < end_run; ++run) {
            const auto [first, last] = tets.kept->runs[static_cast<size_t>(run)];
            body(run, first, last);
          }
        }
      });
    }
    return;
  }
  for (const std::vector<int32_t>& color : tets.coloring.colors) {
    ParallelFor(static_cast<int64_t>(color.size()), 1, [&](int64_t begin, int64_t end) {
      for (int64_t k = begin; k < end; ++k) {
        const int64_t chunk = color[static_cast<size_t>(k)];
        const int64_t first = chunk * TetBatches<T>::kChunkBatches;
        body(chunk, first, std::min(first + TetBatches<T>::kChunkBatches, tets.batch_count()));
      }
    });
  }
}

template <typename T>
void ForEachBatch(const TetBatches<T>& tets, absl::FunctionRef<void(int64_t, int64_t)> body) {
  if (tets.kept) {
    ForEachChunk(tets, [&](int64_t, int64_t first, int64_t last) { body(first, last); });
    return;
  }
  ParallelFor(tets.batch_count(), 2048 / TetBatches<T>::kLanes, body);
}

template struct TetBatches<Double4>;
template struct TetBatches<Float8>;
template TetBatches<Double4> BuildTetBatches(const TetMesh&, const Incidence&,
                                             std::vector<int32_t>);
template void KeepAwake(TetBatches<Double4>&, std::span<uint8_t>);
template void KeepAwake(TetBatches<Float8>&, std::span<uint8_t>);
template TetBatches<Float8> BuildTetBatches(const TetMesh&, const Incidence&, std::vector<int32_t>);
template void ForEachChunk(const TetBatches<Double4>&,
                           absl::FunctionRef<void(int64_t, int64_t, int64_t)>);
template void ForEachChunk(const TetBatches<Float8>&,
                           absl::FunctionRef<void(int64_t, int64_t, int64_t)>);
template void ForEachBatch(const TetBatches<Double4>&, absl::FunctionRef<void(int64_t, int64_t)>);
template void ForEachBatch(const TetBatches<Float8>&, absl::FunctionRef<void(int64_t, int64_t)>);

}  // namespace cleave
