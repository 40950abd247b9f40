#ifndef CLEAVE_CORE_MODEL_BATCH_SCATTER_H_
#define CLEAVE_CORE_MODEL_BATCH_SCATTER_H_

#include <cstring>

#include "core/base/double4.h"
#include "core/model/nodal_vector.h"
#include "core/model/tet_batches.h"

namespace cleave {

// Element matrices of a batch: the blocks of its six edges, each entry of four tets.
struct BatchBlocks {
  Double4 block[6][9];  // [kTetEdges][column by column]
};

inline void AddFloats(Double4 values, float* target) {
  const Float4 sum = LoadFloat4(target) + Narrow(values);
  std::memcpy(target, &sum, sizeof(sum));
}

// Adds the blocks of the batch's first `lanes` tets to those of their edges; overwrites `blocks`.
inline void ScatterBlocks(const TetBatch& batch, int lanes, BatchBlocks& blocks, float* target) {
  for (size_t edge = 0; edge < 6; ++edge) {
    Double4* block = blocks.block[edge];
    Transpose(block[0], block[1], block[2], block[3]);
    Transpose(block[4], block[5], block[6], block[7]);
    for (int lane = 0; lane < lanes; ++lane) {
      float* at = target + 9 * static_cast<int64_t>(batch.edges[edge][static_cast<size_t>(lane)]);
      AddFloats(block[lane], at);
      AddFloats(block[4 + lane], at + 4);
      at[8] += static_cast<float>(block[8][lane]);
    }
  }
}

// Adds forces on the vertices of the batch's first `lanes` tets, [vertex][axis], to those of their
// nodes; overwrites `force`.
inline void ScatterForces(const TetBatch& batch, int lanes, Double4 force[4][4],
                          NodalVector& forces) {
  for (size_t vertex = 0; vertex < 4; ++vertex) {
    Double4* of_vertex = force[vertex];
    of_vertex[3] = Splat(0);
    Transpose(of_vertex[0], of_vertex[1], of_vertex[2], of_vertex[3]);
    for (int lane = 0; lane < lanes; ++lane)
      forces[static_cast<size_t>(batch.nodes[vertex][static_cast<size_t>(lane)])] +=
          of_vertex[lane];
  }
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_BATCH_SCATTER_H_
