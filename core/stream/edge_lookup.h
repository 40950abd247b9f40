#ifndef CLEAVE_CORE_STREAM_EDGE_LOOKUP_H_
#define CLEAVE_CORE_STREAM_EDGE_LOOKUP_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cleave {

// Finds edges by their nodes. It is a view of the edges.
class EdgeLookup {
 public:
  // Precondition: edges ascend, smaller node first, with ids in [0, nodes).
  EdgeLookup(std::span<const std::array<int32_t, 2>> edges, size_t nodes)
      : edges_(edges), firsts_(nodes + 1, 0) {
    for (const std::array<int32_t, 2>& edge : edges) ++firsts_[static_cast<size_t>(edge[0]) + 1];
    for (size_t node = 0; node < nodes; ++node) firsts_[node + 1] += firsts_[node];
  }

  // The edge between two nodes in range, or -1.
  int32_t Find(int32_t a, int32_t b) const {
    const auto low = static_cast<size_t>(std::min(a, b));
    for (size_t edge = firsts_[low]; edge < firsts_[low + 1]; ++edge) {
      if (edges_[edge][1] == std::max(a, b)) return static_cast<int32_t>(edge);
    }
    return -1;
  }

 private:
  std::span<const std::array<int32_t, 2>> edges_;
  std::vector<size_t> firsts_;  // edge of each smaller node
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_EDGE_LOOKUP_H_
