#ifndef CLEAVE_CORE_MODEL_BATCH_SCATTER_H_
#define CLEAVE_CORE_MODEL_BATCH_SCATTER_H_

#include <cstring>

#include "core/base/lanes.h"
#include "core/model/nodal_vector.h"
#include "core/model/tet_batches.h"

namespace cleave {

// Element matrices of a batch: the blocks of its six edges, each entry of as many tets as T has
// lanes.
template <typename T>
struct BatchBlocks {
  T block[6][9];  // [kTetEdges][column by column]
};

// Four rows that Transpose has made of four columns: row of a lane, as what it is added to.
inline Float4 FloatRow(const Double4* rows, int lane) { return Narrow(rows[lane]); }
inline Float4 FloatRow(const Float8* rows, int lane) {
  return lane < 4 ? LowHalf(rows[lane]) : HighHalf(rows[lane - 4]);
}
inline Double4 DoubleRow(const Double4* rows, int lane, double /*unit*/) { return rows[lane]; }
inline Double4 DoubleRow(const Float8* rows, int lane, double unit) {
  return unit * Widen(FloatRow(rows, lane));
}

inline void AddFloats(Float4 values, float* target) {
  const Float4 sum = LoadFloat4(target) + values;
  std::memcpy(target, &sum, sizeof(sum));
}

// Adds the blocks of the batch's first `lanes` tets to those of their edges; overwrites `blocks`.
template <typename T>
void ScatterBlocks(const TetBatch<T>& batch, int lanes, BatchBlocks<T>& blocks, float* target) {
  for (size_t edge = 0; edge < 6; ++edge) {
    T* block = blocks.block[edge];
    Transpose(block[0], block[1], block[2], block[3]);
    Transpose(block[4], block[5], block[6], block[7]);
    for (int lane = 0; lane < lanes; ++lane) {
      float* at = target + 9 * static_cast<int64_t>(batch.edges[edge][static_cast<size_t>(lane)]);
      AddFloats(FloatRow(block, lane), at);
      AddFloats(FloatRow(block + 4, lane), at + 4);
      at[8] += static_cast<float>(block[8][lane]);
    }
  }
}

// Adds forces on vertices 1 to 3 of the batch's first `lanes` tets, (vertex - 1, axis), in `unit`
// (N), to those of their nodes, and to vertex 0 what makes them sum to nothing.
template <typename T>
void ScatterForces(const TetBatch<T>& batch, int lanes, const Matrix3<T>& force, double unit,
                   NodalVector& forces) {
  T rows[3][4];
  for (int vertex = 0; vertex < 3; ++vertex) {
    for (int axis = 0; axis < 3; ++axis) rows[vertex][axis] = force(vertex, axis);
    rows[vertex][3] = T{};
    Transpose(rows[vertex][0], rows[vertex][1], rows[vertex][2], rows[vertex][3]);
  }
  for (int lane = 0; lane < lanes; ++lane) {
    const auto node = [&](size_t vertex) -> Double4& {
      return forces[static_cast<size_t>(batch.nodes[vertex][static_cast<size_t>(lane)])];
    };
    const Double4 of1 = DoubleRow(rows[0], lane, unit);
    const Double4 of2 = DoubleRow(rows[1], lane, unit);
    const Double4 of3 = DoubleRow(rows[2], lane, unit);
    node(0) -= of1 + of2 + of3;
    node(1) += of1;
    node(2) += of2;
    node(3) += of3;
  }
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_BATCH_SCATTER_H_
