#ifndef CLEAVE_CORE_MODEL_TET_BATCHES_H_
#define CLEAVE_CORE_MODEL_TET_BATCHES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/double4.h"
#include "core/base/matrix3.h"
#include "core/base/parallel.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/chunk_coloring.h"
#include "core/model/nodal_vector.h"

namespace cleave {

// Four tets side by side. Their vertices are sorted by node id (the shape functions do not care),
// so that every local edge runs from its smaller to its larger node.
struct TetBatch {
  std::array<std::array<int32_t, kLanes>, 4> nodes;  // [vertex][lane]
  std::array<std::array<int32_t, kLanes>, 6> edges;  // [kTetEdges][lane]
  Double4 gradient[3][3];  // 1/m, of the shape functions of vertices 1 to 3, [vertex - 1][axis]
  Double4 volume;          // m^3, rest volume times damage factor; 0 in lanes that hold no tet
};

// Tets of a mesh in batches, in order, and the chunks in which passes over them run.
struct TetBatches {
  // A chunk's nodes and blocks stay within the first-level cache, and ten thousand tets still make
  // work for a dozen threads.
  static constexpr int64_t kChunkBatches = 64;

  int64_t tet_count = 0;      // in the batches
  std::vector<int32_t> tets;  // which, ascending; empty for all of the mesh
  std::vector<TetBatch> batches;
  ChunkColoring coloring;

  // The tet at a place, which is 4 * batch + lane.
  int64_t tet_at(int64_t place) const {
    return tets.empty() ? place : tets[static_cast<size_t>(place)];
  }
  // The place of a tet, -1 where it is in no batch.
  int64_t place_of(int64_t tet) const;

  int lanes(int64_t batch) const {
    const int64_t left = tet_count - batch * kLanes;
    return left < kLanes ? static_cast<int>(left) : kLanes;
  }
};

// Of the tets that are named, ascending; of all where none is. Precondition: positive rest volumes.
TetBatches BuildTetBatches(const TetMesh& mesh, const Incidence& incidence,
                           std::vector<int32_t> tets);

// m^3.
double RestVolume(const TetMesh& mesh, int64_t tet);

// F - I of a batch; exact zero where all four displacements are equal.
inline Matrix3<Double4> DisplacementGradient(const TetBatch& batch, const Double4* displacements) {
  Double4 at[4][4];  // [vertex][lane], then [vertex][axis]
  for (size_t vertex = 0; vertex < 4; ++vertex) {
    for (size_t lane = 0; lane < kLanes; ++lane)
      at[vertex][lane] = displacements[batch.nodes[vertex][lane]];
    Transpose(at[vertex][0], at[vertex][1], at[vertex][2], at[vertex][3]);
  }
  Matrix3<Double4> gradient;
  for (int i = 0; i < 3; ++i) {
    const Double4 d1 = at[1][i] - at[0][i], d2 = at[2][i] - at[0][i], d3 = at[3][i] - at[0][i];
    for (int j = 0; j < 3; ++j) {
      gradient(i, j) =
          d1 * batch.gradient[0][j] + d2 * batch.gradient[1][j] + d3 * batch.gradient[2][j];
    }
  }
  return gradient;
}

// Runs body(chunk, first batch, end batch) over all chunks in the order of the colouring.
template <typename Body>
void ForEachChunk(const TetBatches& tets, const Body& body) {
  const auto batch_count = static_cast<int64_t>(tets.batches.size());
  for (const std::vector<int32_t>& color : tets.coloring.colors) {
    ParallelFor(static_cast<int64_t>(color.size()), 1, [&](int64_t begin, int64_t end) {
      for (int64_t k = begin; k < end; ++k) {
        const int64_t chunk = color[static_cast<size_t>(k)];
        const int64_t first = chunk * TetBatches::kChunkBatches;
        body(chunk, first, std::min(first + TetBatches::kChunkBatches, batch_count));
      }
    });
  }
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_TET_BATCHES_H_
