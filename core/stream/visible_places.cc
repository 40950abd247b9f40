#include "core/stream/visible_places.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/mesh/tet_mesh.h"
#include "core/stream/edge_lookup.h"

namespace cleave {
namespace {

constexpr size_t kAhead = 8;  // how far ahead that is fetched which will be read

constexpr uint8_t kSeen = 1;   // visible before
constexpr uint8_t kFresh = 2;  // only since the Break in work; above kSeen

// Of each set of a tet's edges, bit k for kTetEdges[k]: whether the others do not join its
// vertices.
constexpr std::array<bool, 64> kIsApart = [] {
  std::array<bool, 64> is_apart{};
  for (size_t broken = 0; broken < is_apart.size(); ++broken) {
    std::array<size_t, 4> joined = {0, 1, 2, 3};
    for (size_t k = 0; k < 6; ++k) {
      if ((broken >> k & 1) != 0) continue;
      const auto [a, b] = kTetEdges[k];
      const size_t from = joined[static_cast<size_t>(a)];
      const size_t to = joined[static_cast<size_t>(b)];
      for (size_t& vertex : joined) {
        if (vertex == std::max(from, to)) vertex = std::min(from, to);
      }
    }
    for (const size_t vertex : joined) is_apart[broken] = is_apart[broken] || vertex > 0;
  }
  return is_apart;
}();

// Marks the places of faces that only one tet has.
std::vector<uint8_t> MarkBoundary(size_t count, std::span<const std::array<int32_t, 4>> tets) {
  // Faces by their smallest place; of each the two others in order.
  std::vector<size_t> ends(count + 1, 0);
  const auto for_faces = [&](const auto& visit) {
    for (const std::array<int32_t, 4>& tet : tets) {
      for (size_t without = 0; without < 4; ++without) {
        std::array<int32_t, 3> face;
        for (size_t i = 0, k = 0; i < 4; ++i) {
          if (i != without) face[k++] = tet[i];
        }
        std::sort(face.begin(), face.end());
        visit(face);
      }
    }
  };
  for_faces([&](const std::array<int32_t, 3>& face) { ++ends[static_cast<size_t>(face[0]) + 1]; });
  for (size_t place = 0; place < count; ++place) ends[place + 1] += ends[place];
  std::vector<std::pair<int32_t, int32_t>> others(ends[count]);
  for_faces([&](const std::array<int32_t, 3>& face) {
    others[ends[static_cast<size_t>(face[0])]++] = {face[1], face[2]};
  });
  std::vector<uint8_t> is_boundary(count, 0);
  size_t begin = 0;
  for (size_t place = 0; place < count; ++place) {
    const size_t end = ends[place];
    std::sort(others.begin() + static_cast<std::ptrdiff_t>(begin),
              others.begin() + static_cast<std::ptrdiff_t>(end));
    for (size_t at = begin; at < end;) {
      size_t next = at + 1;
      while (next < end && others[next] == others[at]) ++next;
      if (next == at + 1) {
        is_boundary[place] = 1;
        is_boundary[static_cast<size_t>(others[at].first)] = 1;
        is_boundary[static_cast<size_t>(others[at].second)] = 1;
      }
      at = next;
    }
    begin = end;
  }
  return is_boundary;
}

}  // namespace

VisiblePlaces::VisiblePlaces(const NodeOrder& order, std::span<const std::array<int32_t, 2>> edges,
                             std::span<const std::array<int32_t, 4>> tets)
    : masks_(tets.size(), 0),
      offsets_(edges.size() + 1, 0),
      edge_tets_(6 * tets.size()),
      edge_bits_(6 * tets.size()) {
  const size_t count = order.nodes.size();
  const EdgeLookup lookup(edges, count);
  const auto for_edges = [&](const auto& visit) {
    for (size_t tet = 0; tet < tets.size(); ++tet) {
      for (size_t k = 0; k < kTetEdges.size(); ++k) {
        const auto [a, b] = kTetEdges[k];
        const int32_t edge =
            lookup.Find(tets[tet][static_cast<size_t>(a)], tets[tet][static_cast<size_t>(b)]);
        visit(static_cast<size_t>(edge), tet, k);
      }
    }
  };
  for_edges([&](size_t edge, size_t, size_t) { ++offsets_[edge + 1]; });
  for (size_t edge = 0; edge < edges.size(); ++edge) offsets_[edge + 1] += offsets_[edge];
  std::vector<int32_t> next(offsets_.begin(), offsets_.end() - 1);
  for_edges([&](size_t edge, size_t tet, size_t k) {
    const auto at = static_cast<size_t>(next[edge]++);
    edge_tets_[at] = static_cast<int32_t>(tet);
    edge_bits_[at] = static_cast<uint8_t>(1u << k);
  });
  const std::vector<int32_t> places = order.PlacesOfNodes();
  tets_.reserve(tets.size());
  for (const std::array<int32_t, 4>& tet : tets) {
    std::array<int32_t, 4>& placed = tets_.emplace_back();
    for (size_t i = 0; i < 4; ++i) placed[i] = places[static_cast<size_t>(tet[i])];
  }
  is_boundary_ = MarkBoundary(count, tets_);
  Heal();
}

void VisiblePlaces::Heal() {
  std::fill(masks_.begin(), masks_.end(), uint8_t{0});
  is_visible_ = is_boundary_;
  is_apart_.assign(is_boundary_.size(), 0);
  List();
}

void VisiblePlaces::List() {
  places_.clear();
  fresh_.clear();
  std::array<int32_t, 256> visible, fresh;
  for (size_t begin = 0; begin < is_visible_.size(); begin += visible.size()) {
    const size_t end = std::min(is_visible_.size(), begin + visible.size());
    size_t visible_count = 0;
    size_t fresh_count = 0;
    for (size_t place = begin; place < end; ++place) {  // without branches, as in Stencils
      const uint8_t is_visible = is_visible_[place];
      visible[visible_count] = fresh[fresh_count] = static_cast<int32_t>(place);
      visible_count += static_cast<size_t>(is_visible != 0);
      fresh_count += static_cast<size_t>(is_visible == kFresh);
      is_visible_[place] = std::min(is_visible, kSeen);
    }
    places_.insert(places_.end(), visible.data(), visible.data() + visible_count);
    fresh_.insert(fresh_.end(), fresh.data(), fresh.data() + fresh_count);
  }
}

const std::vector<int32_t>& VisiblePlaces::Break(const EdgeGraph& graph,
                                                 std::span<const int32_t> edges) {
  // Step by step, so that what the next one reads can be fetched ahead.
  std::vector<int32_t> tets;  // that come apart
  for (size_t k = 0; k < edges.size(); ++k) {
    if (k + kAhead < edges.size()) {
      for (const int32_t tet : TetsOf(edges[k + kAhead])) __builtin_prefetch(masks_.data() + tet);
    }
    const auto begin = static_cast<size_t>(offsets_[static_cast<size_t>(edges[k])]);
    const std::span<const int32_t> of_edge = TetsOf(edges[k]);
    for (size_t at = 0; at < of_edge.size(); ++at) {
      uint8_t& mask = masks_[static_cast<size_t>(of_edge[at])];
      const bool was_apart = kIsApart[mask];
      mask |= edge_bits_[begin + at];
      if (was_apart || !kIsApart[mask]) continue;
      tets.push_back(of_edge[at]);
      __builtin_prefetch(tets_.data() + of_edge[at]);
    }
  }
  std::vector<int32_t> apart;  // places of tets that come apart
  for (const int32_t tet : tets) {
    for (const int32_t place : tets_[static_cast<size_t>(tet)]) {
      uint8_t& is_apart = is_apart_[static_cast<size_t>(place)];
      if (is_apart == 0) apart.push_back(place);
      is_apart = 1;
    }
  }
  const auto show = [&](int32_t place) {
    uint8_t& is_visible = is_visible_[static_cast<size_t>(place)];
    is_visible = is_visible == 0 ? kFresh : is_visible;
  };
  for (size_t k = 0; k < apart.size(); ++k) {
    if (k + kAhead < apart.size()) graph.Prefetch(apart[k + kAhead]);
    show(apart[k]);
    for (const int32_t other : graph.Neighbours(apart[k])) show(std::max(other, ~other));
  }
  List();
  return fresh_;
}

}  // namespace cleave
