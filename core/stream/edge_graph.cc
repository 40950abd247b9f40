#include "core/stream/edge_graph.h"

#include <cstddef>

namespace cleave {
namespace {

int32_t PlaceOf(int32_t slot) { return slot < 0 ? ~slot : slot; }

}  // namespace

EdgeGraph::EdgeGraph(const NodeOrder& order, std::span<const std::array<int32_t, 2>> edges) {
  const size_t count = order.nodes.size();
  const std::vector<int32_t> places = order.PlacesOfNodes();
  offsets_.assign(count + 1, 0);
  for (const std::array<int32_t, 2>& edge : edges) {
    for (const int32_t node : edge) {
      ++offsets_[static_cast<size_t>(places[static_cast<size_t>(node)]) + 1];
    }
  }
  for (size_t place = 0; place < count; ++place) offsets_[place + 1] += offsets_[place];
  // The edges of each place in any order, then each place into its neighbours' lists, ascending.
  const auto slots = static_cast<size_t>(offsets_.back());
  std::vector<int32_t> incident(slots);
  std::vector<int32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (size_t edge = 0; edge < edges.size(); ++edge) {
    for (const int32_t node : edges[edge]) {
      const auto place = static_cast<size_t>(places[static_cast<size_t>(node)]);
      incident[static_cast<size_t>(next[place]++)] = static_cast<int32_t>(edge);
    }
  }
  slots_.resize(slots);
  edge_slots_.resize(edges.size());
  next.assign(offsets_.begin(), offsets_.end() - 1);
  for (size_t place = 0; place < count; ++place) {
    const auto end = static_cast<size_t>(offsets_[place + 1]);
    for (auto at = static_cast<size_t>(offsets_[place]); at < end; ++at) {
      const auto edge = static_cast<size_t>(incident[at]);
      const int32_t first = places[static_cast<size_t>(edges[edge][0])];
      const bool is_first = first == static_cast<int32_t>(place);
      const int32_t other = is_first ? places[static_cast<size_t>(edges[edge][1])] : first;
      const int32_t slot = next[static_cast<size_t>(other)]++;
      slots_[static_cast<size_t>(slot)] = static_cast<int32_t>(place);
      edge_slots_[edge][is_first ? 0 : 1] = slot;
    }
  }
}

std::array<int32_t, 2> EdgeGraph::Ends(int32_t edge) const {
  const std::array<int32_t, 2>& slots = edge_slots_[static_cast<size_t>(edge)];
  return {PlaceOf(slots_[static_cast<size_t>(slots[0])]),
          PlaceOf(slots_[static_cast<size_t>(slots[1])])};
}

LargeVector<int32_t> EdgeGraph::EdgesOfSlots() const {
  LargeVector<int32_t> edges(slots_.size());
  for (size_t edge = 0; edge < edge_slots_.size(); ++edge) {
    for (const int32_t slot : edge_slots_[edge]) {
      edges[static_cast<size_t>(slot)] = static_cast<int32_t>(edge);
    }
  }
  return edges;
}

void EdgeGraph::Break(int32_t edge) {
  for (const int32_t at : edge_slots_[static_cast<size_t>(edge)]) {
    int32_t& slot = slots_[static_cast<size_t>(at)];
    slot = ~PlaceOf(slot);
  }
}

void EdgeGraph::Heal() {
  for (int32_t& slot : slots_) slot = PlaceOf(slot);
}

}  // namespace cleave
