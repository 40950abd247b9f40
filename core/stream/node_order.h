#ifndef CLEAVE_CORE_STREAM_NODE_ORDER_H_
#define CLEAVE_CORE_STREAM_NODE_ORDER_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// Nodes in groups from coarse to fine, so that each lies amid nodes of the groups before;
// FORMAT.md, "Order 2". A node's position in this order is its place.
struct NodeOrder {
  // A coarser node by its Morton code, for the search around a place.
  struct Coarse {
    uint64_t code;
    int32_t place;
  };

  std::vector<int32_t> nodes;         // mesh node of each place
  std::vector<uint64_t> codes;        // Morton code of each place
  std::vector<int32_t> group_begins;  // first place of each group, and the number of places
  std::vector<int> cube_bits;  // of each group: the search cubes' side is 2^bits Morton steps
  std::vector<std::vector<Coarse>> coarser;  // of each group: all places before it, by code

  int64_t groups() const { return static_cast<int64_t>(group_begins.size()) - 1; }
  size_t GroupOf(int32_t place) const;
  std::vector<int32_t> PlacesOfNodes() const;  // the inverse of `nodes`
};

// Precondition: coordinates are finite; at least one node.
NodeOrder MakeNodeOrder(std::span<const Vec3> rest_positions);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_NODE_ORDER_H_
