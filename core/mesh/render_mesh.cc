#include "core/mesh/render_mesh.h"

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <unordered_map>

namespace cleave {

int64_t CountOpenEdges(const std::vector<std::array<int32_t, 3>>& triangles) {
  // How much oftener an edge is run through from its smaller point.
  std::unordered_map<uint64_t, int32_t> surplus;
  surplus.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<uint64_t>(triangle[k]);
      const auto b = static_cast<uint64_t>(triangle[(k + 1) % 3]);
      if (a != b) surplus[a < b ? a << 32 | b : b << 32 | a] += a < b ? 1 : -1;
    }
  }
  int64_t open = 0;
  for (const auto& [edge, count] : surplus) open += std::abs(count);
  return open;
}

}  // namespace cleave
