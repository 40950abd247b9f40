#ifndef CLEAVE_CORE_MODEL_CHUNK_COLORING_H_
#define CLEAVE_CORE_MODEL_CHUNK_COLORING_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cleave {

// Chunks of consecutive tets in groups within which no two chunks share a node. One group after the
// other, the chunks of a group at once and each in the order of its tets: every node then gets its
// sums in the same order for any number of threads, and no thread waits for another's node.
struct ChunkColoring {
  int64_t chunk_size = 0;  // tets
  std::vector<std::vector<int32_t>> colors;
};

// Greedy, in chunk order. `tets` name nodes in [0, node_count).
ChunkColoring ColorChunks(std::span<const std::array<int32_t, 4>> tets, int64_t node_count,
                          int64_t chunk_size);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_CHUNK_COLORING_H_
