#include "core/model/chunk_coloring.h"

#include <algorithm>
#include <bit>

namespace cleave {

ChunkColoring ColorChunks(std::span<const std::array<int32_t, 4>> tets, int64_t node_count,
                          int64_t chunk_size) {
  ChunkColoring coloring;
  coloring.chunk_size = chunk_size;
  const auto tet_count = static_cast<int64_t>(tets.size());
  std::vector<int32_t> open;
  for (int64_t begin = 0; begin < tet_count; begin += chunk_size)
    open.push_back(static_cast<int32_t>(begin / chunk_size));

  // 64 colours a round; a node in more chunks than that sends the rest to the next round.
  while (!open.empty()) {
    const size_t first_color = coloring.colors.size();
    std::vector<uint64_t> used(static_cast<size_t>(node_count), 0);
    std::vector<int32_t> left;
    for (const int32_t chunk : open) {
      const int64_t begin = chunk * chunk_size;
      const auto members = tets.subspan(
          static_cast<size_t>(begin), static_cast<size_t>(std::min(chunk_size, tet_count - begin)));
      uint64_t taken = 0;
      for (const auto& tet : members) {
        for (const int32_t node : tet) taken |= used[static_cast<size_t>(node)];
      }
      const int color = std::countr_one(taken);
      if (color == 64) {
        left.push_back(chunk);
        continue;
      }
      for (const auto& tet : members) {
        for (const int32_t node : tet) used[static_cast<size_t>(node)] |= uint64_t{1} << color;
      }
      const size_t index = first_color + static_cast<size_t>(color);
      if (index >= coloring.colors.size()) coloring.colors.resize(index + 1);
      coloring.colors[index].push_back(chunk);
    }
    open = std::move(left);
  }
  return coloring;
}

}  // namespace cleave
