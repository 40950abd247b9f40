#ifndef CLEAVE_CORE_MODEL_TET_BATCHES_H_
#define CLEAVE_CORE_MODEL_TET_BATCHES_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/base/lanes.h"
#include "core/base/matrix3.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/chunk_coloring.h"
#include "core/model/nodal_vector.h"

namespace cleave {

// As many tets side by side as T has lanes. Their vertices are sorted by node id (the shape
// functions do not care), so that every local edge runs from its smaller to its larger node.
template <typename T>
struct TetBatch {
  template <size_t kCount>
  using Ids = std::array<std::array<int32_t, Lanes<T>::kCount>, kCount>;

  Ids<4> nodes;  // [vertex][lane]
  Ids<6> edges;  // [kTetEdges][lane]
  Matrix3<T>
      gradient;  // 1/length_unit, of the shape functions of vertices 1 to 3, (vertex - 1, axis)
  T volume;      // length_unit^3, rest volume times damage factor; 0 in lanes that hold no tet
};

// Runs of batches that passes keep to, each within a chunk.
struct BatchRuns {
  std::vector<std::array<int64_t, 2>> runs;  // first and end batch
  // Of each colour, for each chunk: its first and end run, which share nodes.
  std::vector<std::vector<std::array<int32_t, 2>>> colors;
};

// Tets of a mesh in batches, in order, and the chunks in which passes over them run.
template <typename T>
struct TetBatches {
  static constexpr int64_t kLanes = Lanes<T>::kCount;
  // A chunk's nodes and blocks stay within the first-level cache, and ten thousand tets still make
  // work for a dozen threads.
  static constexpr int64_t kChunkBatches = 256 / kLanes;

  int64_t tet_count = 0;      // in the batches
  std::vector<int32_t> tets;  // which, ascending; empty for all of the mesh
  // m, a power of two. In double 1; in float near the size of the tets, so that no power of a
  // length leaves the range.
  double length_unit = 1;
  std::vector<TetBatch<T>> batches;
  ChunkColoring coloring;
  std::optional<BatchRuns> kept;  // while other batches are left out

  // The tet at a place, which is kLanes * batch + lane.
  int64_t tet_at(int64_t place) const {
    return tets.empty() ? place : tets[static_cast<size_t>(place)];
  }
  // The place of a tet, -1 where it is in no batch.
  int64_t place_of(int64_t tet) const;

  int64_t batch_count() const { return static_cast<int64_t>(batches.size()); }
  int64_t chunk_count() const { return (batch_count() + kChunkBatches - 1) / kChunkBatches; }
  // What ForEachChunk counts.
  int64_t pass_chunk_count() const {
    return kept ? static_cast<int64_t>(kept->runs.size()) : chunk_count();
  }
  int lanes(int64_t batch) const {
    const int64_t left = tet_count - batch * kLanes;
    return static_cast<int>(left < kLanes ? left : kLanes);
  }
};

// Of the tets that are named, ascending; of all where none is. Precondition: positive rest volumes.
template <typename T>
TetBatches<T> BuildTetBatches(const TetMesh& mesh, const Incidence& incidence,
                              std::vector<int32_t> tets);

// Keeps passes to the batches of which some tet is not `asleep` (a tet of the mesh each; empty:
// none is), and sets the entries of all tets in those to 0.
template <typename T>
void KeepAwake(TetBatches<T>& tets, std::span<uint8_t> asleep);

// m^3.
double RestVolume(const TetMesh& mesh, int64_t tet);

// How vertices 1 to 3 of a batch have moved against vertex 0, length_unit, (vertex - 1, axis). The
// differences are taken in double.
inline Matrix3<Double4> VertexMoves(const TetBatch<Double4>& batch, const Double4* displacements,
                                    double /*length_unit*/) {
  Matrix3<Double4> moves;
  for (size_t vertex = 1; vertex < 4; ++vertex) {
    Double4 at[4];  // [lane], then [axis]
    for (size_t lane = 0; lane < 4; ++lane) {
      at[lane] = displacements[batch.nodes[vertex][lane]] - displacements[batch.nodes[0][lane]];
    }
    Transpose(at[0], at[1], at[2], at[3]);
    for (int axis = 0; axis < 3; ++axis) moves(static_cast<int>(vertex) - 1, axis) = at[axis];
  }
  return moves;
}

inline Matrix3<Float8> VertexMoves(const TetBatch<Float8>& batch, const Double4* displacements,
                                   double length_unit) {
  const double scale = 1 / length_unit;
  Matrix3<Float8> moves;
  for (size_t vertex = 1; vertex < 4; ++vertex) {
    const auto move = [&](size_t lane) {
      return Narrow(
          scale * (displacements[batch.nodes[vertex][lane]] - displacements[batch.nodes[0][lane]]));
    };
    Float8 at[4];  // [lane of a half], then [axis]
    for (size_t lane = 0; lane < 4; ++lane) at[lane] = Join(move(lane), move(lane + 4));
    Transpose(at[0], at[1], at[2], at[3]);
    for (int axis = 0; axis < 3; ++axis) moves(static_cast<int>(vertex) - 1, axis) = at[axis];
  }
  return moves;
}

// F - I of a batch from its moves and shape gradients; exact zero where nothing moved.
template <typename T>
Matrix3<T> DisplacementGradient(const Matrix3<T>& moves, const Matrix3<T>& gradient) {
  Matrix3<T> result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result(i, j) = moves(0, i) * gradient(0, j) + moves(1, i) * gradient(1, j) +
                     moves(2, i) * gradient(2, j);
    }
  }
  return result;
}

// Runs body(chunk, first batch, end batch) over all chunks in the order of the colouring; where
// batches are left out, over the runs that are kept instead.
template <typename T>
void ForEachChunk(const TetBatches<T>& tets,
                  absl::FunctionRef<void(int64_t, int64_t, int64_t)> body);

// Runs body(first batch, end batch) over all batches that are not left out; for passes that write
// only to their own tets.
template <typename T>
void ForEachBatch(const TetBatches<T>& tets, absl::FunctionRef<void(int64_t, int64_t)> body);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_TET_BATCHES_H_
