#ifndef CLEAVE_CORE_STREAM_EDGE_GRAPH_H_
#define CLEAVE_CORE_STREAM_EDGE_GRAPH_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_vector.h"
#include "core/stream/node_order.h"

namespace cleave {

// Which places share an edge, with a mark on the broken ones inside the lists.
class EdgeGraph {
 public:
  // Precondition: node ids of edges are in range.
  EdgeGraph(const NodeOrder& order, std::span<const std::array<int32_t, 2>> edges);

  // The places that share an edge with `place`, ascending; that of a broken edge as ~place, which
  // is negative.
  std::span<const int32_t> Neighbours(int32_t place) const {
    const auto begin = static_cast<size_t>(offsets_[static_cast<size_t>(place)]);
    const auto end = static_cast<size_t>(offsets_[static_cast<size_t>(place) + 1]);
    return {slots_.data() + begin, end - begin};
  }
  // Where the first of them is in EdgesOfSlots.
  size_t SlotOf(int32_t place) const {
    return static_cast<size_t>(offsets_[static_cast<size_t>(place)]);
  }
  // The edges to all of them, of all places.
  LargeVector<int32_t> EdgesOfSlots() const;
  // Fetches the first of them.
  void Prefetch(int32_t place) const {
    __builtin_prefetch(slots_.data() + offsets_[static_cast<size_t>(place)]);
  }
  // Fetches what PrefetchEdge needs, and then what Ends and Break do.
  void PrefetchSlots(int32_t edge) const {
    __builtin_prefetch(edge_slots_.data() + static_cast<size_t>(edge));
  }
  void PrefetchEdge(int32_t edge) const {
    for (const int32_t slot : edge_slots_[static_cast<size_t>(edge)]) {
      __builtin_prefetch(slots_.data() + slot);
    }
  }
  // The two ends of an edge, as places.
  std::array<int32_t, 2> Ends(int32_t edge) const;

  void Break(int32_t edge);
  void Heal();  // every edge

  int32_t places() const { return static_cast<int32_t>(offsets_.size()) - 1; }
  int32_t edges() const { return static_cast<int32_t>(edge_slots_.size()); }

 private:
  std::vector<int32_t> offsets_;
  LargeVector<int32_t> slots_;
  LargeVector<std::array<int32_t, 2>> edge_slots_;  // where each edge stands in slots_
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_EDGE_GRAPH_H_
