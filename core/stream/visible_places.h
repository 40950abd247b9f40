#ifndef CLEAVE_CORE_STREAM_VISIBLE_PLACES_H_
#define CLEAVE_CORE_STREAM_VISIBLE_PLACES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_vector.h"
#include "core/stream/edge_graph.h"
#include "core/stream/node_order.h"

namespace cleave {

// The places that a surface view carries: FORMAT.md, "Visible places". They are what surfaces are
// drawn from (core/surface): nodes of the boundary, nodes of tets that have come apart, and for the
// deformation round these whatever shares an edge with them. While edges break they only grow.
class VisiblePlaces {
 public:
  // No edge is broken. Preconditions: node ids are in range, edges ascend and are those of the
  // tets.
  VisiblePlaces(const NodeOrder& order, std::span<const std::array<int32_t, 2>> edges,
                std::span<const std::array<int32_t, 4>> tets);

  // Breaks more edges of `graph`, which is that of the same mesh. Returns the places that are
  // visible only now, ascending. The work is in proportion to what breaks, but for a scan.
  const std::vector<int32_t>& Break(const EdgeGraph& graph, std::span<const int32_t> edges);
  // All edges are whole again.
  void Heal();

  bool Has(int32_t place) const { return is_visible_[static_cast<size_t>(place)] != 0; }
  const std::vector<uint8_t>& marks() const { return is_visible_; }  // by place: 0 or not
  const std::vector<int32_t>& places() const { return places_; }     // visible ones, ascending

 private:
  void List();
  std::span<const int32_t> TetsOf(int32_t edge) const {
    const auto begin = static_cast<size_t>(offsets_[static_cast<size_t>(edge)]);
    const auto end = static_cast<size_t>(offsets_[static_cast<size_t>(edge) + 1]);
    return std::span(edge_tets_).subspan(begin, end - begin);
  }

  LargeVector<std::array<int32_t, 4>> tets_;  // as places
  std::vector<uint8_t> masks_;                // of each tet: bit k for a broken edge kTetEdges[k]
  LargeVector<int32_t> offsets_;              // of each edge in edge_tets_
  LargeVector<int32_t> edge_tets_;
  LargeVector<uint8_t>
      edge_bits_;  // of each entry of edge_tets_: the edge's bit in that tet's mask
  std::vector<uint8_t> is_boundary_;  // by place
  std::vector<uint8_t> is_visible_;
  std::vector<uint8_t> is_apart_;  // by place: of a tet that has come apart
  std::vector<int32_t> places_;
  std::vector<int32_t> fresh_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_VISIBLE_PLACES_H_
