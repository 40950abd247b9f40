#include "core/stream/node_order.h"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "core/mesh/morton.h"

namespace cleave {

std::vector<int32_t> NodeOrder::PlacesOfNodes() const {
  std::vector<int32_t> places(nodes.size());
  for (size_t place = 0; place < nodes.size(); ++place) {
    places[static_cast<size_t>(nodes[place])] = static_cast<int32_t>(place);
  }
  return places;
}

size_t NodeOrder::GroupOf(int32_t place) const {
  return static_cast<size_t>(std::upper_bound(group_begins.begin(), group_begins.end(), place) -
                             group_begins.begin()) -
         1;
}

NodeOrder MakeNodeOrder(std::span<const Vec3> rest_positions) {
  const size_t count = rest_positions.size();
  struct Entry {
    uint64_t code;
    int32_t node;
  };
  std::vector<Entry> curve(count);
  const MortonCurve morton(std::vector<Vec3>(rest_positions.begin(), rest_positions.end()));
  for (size_t node = 0; node < count; ++node) {
    curve[node] = {morton.CodeOf(rest_positions[node]), static_cast<int32_t>(node)};
  }
  std::sort(curve.begin(), curve.end(), [](const Entry& a, const Entry& b) {
    return a.code != b.code ? a.code < b.code : a.node < b.node;
  });

  // The level of a node: the highest bit in which its code differs from the one before it.
  constexpr int kTopLevel = 64;
  std::vector<uint8_t> levels(count);
  std::vector<size_t> sizes(kTopLevel + 1, 0);
  for (size_t at = 0; at < count; ++at) {
    levels[at] = static_cast<uint8_t>(
        at == 0 ? kTopLevel : std::bit_width(curve[at].code ^ curve[at - 1].code));
    ++sizes[levels[at]];
  }
  // Levels with less than a twentieth of the nodes before them join the next.
  std::vector<uint8_t> group_of_level(kTopLevel + 1, 0);
  NodeOrder order;
  order.group_begins.push_back(0);
  size_t before = 0;
  size_t size = 0;
  int top = -1;
  const auto close = [&] {
    before += size;
    order.group_begins.push_back(static_cast<int32_t>(before));
    order.cube_bits.push_back((std::min(top, 63) + 2) / 3);
    size = 0;
    top = -1;
  };
  for (int level = kTopLevel; level >= 0; --level) {
    const size_t of_level = sizes[static_cast<size_t>(level)];
    group_of_level[static_cast<size_t>(level)] = static_cast<uint8_t>(order.groups());
    if (of_level == 0) continue;
    if (top < 0) top = level;
    size += of_level;
    if (20 * size >= before) close();
  }
  if (size > 0) close();

  const auto groups = static_cast<size_t>(order.groups());
  order.nodes.resize(count);
  order.codes.resize(count);
  order.coarser.resize(groups);
  for (size_t group = 1; group < groups; ++group) {
    order.coarser[group].reserve(static_cast<size_t>(order.group_begins[group]));
  }
  std::vector<int32_t> next(order.group_begins.begin(), order.group_begins.end() - 1);
  for (size_t at = 0; at < count; ++at) {
    const size_t group = group_of_level[levels[at]];
    const int32_t place = next[group]++;
    order.nodes[static_cast<size_t>(place)] = curve[at].node;
    order.codes[static_cast<size_t>(place)] = curve[at].code;
    for (size_t finer = group + 1; finer < groups; ++finer) {
      order.coarser[finer].push_back({curve[at].code, place});
    }
  }
  return order;
}

}  // namespace cleave
