#include "core/model/tet_batches.h"

#include <Eigen/Dense>
#include <algorithm>

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

TetBatches BuildTetBatches(const TetMesh& mesh, const Incidence& incidence) {
  TetBatches result;
  result.tet_count = mesh.tet_count();
  result.batches.resize(static_cast<size_t>((mesh.tet_count() + kLanes - 1) / kLanes));
  result.coloring = ColorChunks(mesh.tets, mesh.node_count(), TetBatches::kChunkBatches * kLanes);
  ParallelFor(static_cast<int64_t>(result.batches.size()), 256, [&](int64_t begin, int64_t end) {
    for (int64_t b = begin; b < end; ++b) {
      TetBatch& batch = result.batches[static_cast<size_t>(b)];
      for (size_t lane = 0; lane < kLanes; ++lane) {
        // Lanes past the last tet repeat it with no volume.
        const int64_t tet = std::min(b * kLanes + static_cast<int64_t>(lane), mesh.tet_count() - 1);
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
        const Eigen::Matrix3d inverse = RestEdges(mesh, nodes).inverse();
        for (int vertex = 0; vertex < 3; ++vertex) {
          for (int axis = 0; axis < 3; ++axis)
            batch.gradient[vertex][axis][lane] = inverse(vertex, axis);
        }
        batch.volume[lane] =
            b * kLanes + static_cast<int64_t>(lane) < mesh.tet_count() ? RestVolume(mesh, tet) : 0;
      }
    }
  });
  return result;
}

}  // namespace cleave
