// What is apart in Stencils of a surface view.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>

#include "core/base/parallel.h"
#include "core/stream/stencils.h"

namespace cleave {
namespace {

constexpr int64_t kAhead = 4;  // how far ahead that is fetched which will be read

}  // namespace

void Stencils::FindLeaders() {
  view_->leaders.clear();
  view_->leader_of.assign(static_cast<size_t>(pieces_.count()), -1);
  for (const int32_t place : view_->visible.places()) {
    int32_t& leader = view_->leader_of[static_cast<size_t>(pieces_[place])];
    if (leader >= 0) continue;
    leader = place;
    view_->leaders.push_back(place);
  }
}

// Touches all whose choice can be another than it was, where these places lost edges.
void Stencils::TouchInView(std::span<const int32_t> ends, bool splits) {
  // What lost an edge that led to a place of its stencil is an end of it, or next to one.
  ParallelFor(static_cast<int64_t>(ends.size()), 256, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      if (at + 2 * kAhead < end) graph_.Prefetch(ends[static_cast<size_t>(at + 2 * kAhead)]);
      Touch(ends[static_cast<size_t>(at)]);
      for (const int32_t next : graph_.Neighbours(ends[static_cast<size_t>(at)])) {
        if (next >= 0) Touch(next);
      }
    }
  });
  // Places that come into view, and whoever has one nearer than the last of theirs.
  ParallelFor(static_cast<int64_t>(fresh_.size()), 256, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      if (at + kAhead < end) {
        const auto next = view_->near->ReadersOf(fresh_[static_cast<size_t>(at + kAhead)]);
        for (size_t k = 0; k < next.size() && k < 32; k += 8) __builtin_prefetch(next.data() + k);
      }
      const int32_t place = fresh_[static_cast<size_t>(at)];
      Touch(place);
      for (const NearPlaces::Reader& reader : view_->near->ReadersOf(place)) {
        if (reader.rank < view_->ranks[static_cast<size_t>(reader.place)]) Touch(reader.place);
      }
    }
  });
  // Places of the same piece that no edges led to, and leaders.
  const std::vector<int32_t>& places = view_->visible.places();
  ParallelFor(static_cast<int64_t>(places.size()), 8192, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const int32_t place = places[at];
      const Kind kind = view_->kinds[static_cast<size_t>(place)];
      if (kind == kNoneFound || (kind == kSomeInSpace && splits && LostPlaces(place))) {
        Touch(place);
      }
    }
  });
}

// The places that a visible place is to be predicted from. False if it has them already.
bool Stencils::ChooseInView(int32_t place) {
  const auto index = static_cast<size_t>(place);
  const int32_t piece = pieces_[place];
  const uint8_t* const visible = view_->visible.marks().data();
  const int32_t* const labels = pieces_.labels().data();
  const uint64_t* const broken = view_->broken.data();
  const auto is_broken = [&](int32_t edge) {
    return broken[static_cast<size_t>(edge) / 64] >> (edge % 64) & 1;
  };
  const int32_t no_edge = view_->near->no_edge();
  std::array<int32_t, kStencilNodes + 1> chosen;
  size_t count = 0;
  size_t rank = 0;
  bool is_in_space = false;
  for (const NearPlaces::Near& near : view_->near->Of(place)) {
    const bool is_one = (visible[near.place] != 0) & (labels[near.place] == piece) &
                        ((is_broken(near.edges[0]) | is_broken(near.edges[1])) == 0);
    chosen[count] = near.place;
    count += static_cast<size_t>(is_one);
    is_in_space |= is_one & (near.edges[0] == no_edge);
    if (count == kStencilNodes) break;
    ++rank;
  }
  Kind kind = is_in_space ? kSomeInSpace : kAllByEdges;
  if (count == 0) {
    const int32_t leader = LeaderOf(piece);
    chosen[0] = leader == place ? -1 : leader;
    kind = kNoneFound;
  }
  for (size_t k = std::max(count, size_t{1}); k < kStencilNodes; ++k) chosen[k] = chosen[0];
  uint16_t& last = view_->ranks[index];
  const bool is_new = last == 0;
  last = static_cast<uint16_t>(count == kStencilNodes ? rank : kMaxNearPlaces);
  view_->kinds[index] = kind;
  Stencil& stencil = stencils_[index];
  constexpr size_t kBytes = sizeof(stencil.places);
  if (!is_new && std::memcmp(stencil.places.data(), chosen.data(), kBytes) == 0) return false;
  std::memcpy(stencil.places.data(), chosen.data(), kBytes);
  return true;
}

// Leaves of what was touched that which changes.
void Stencils::ChooseForTouched() {
  ParallelFor(static_cast<int64_t>(touched_.size()), 256, [&](int64_t begin, int64_t end) {
    constexpr size_t kLanes = 4;
    std::array<int32_t, kLanes> changed;
    size_t count = 0;
    for (int64_t at = begin; at < end; ++at) {
      if (at + kAhead < end) {
        const auto next = view_->near->Of(touched_[static_cast<size_t>(at + kAhead)]);
        for (size_t k = 0; k < next.size() && k < 20; k += 5) __builtin_prefetch(next.data() + k);
      }
      const int32_t place = touched_[static_cast<size_t>(at)];
      if (!view_->visible.Has(place) || !ChooseInView(place)) continue;
      marks_[static_cast<size_t>(place)] = 1;
      changed[count++] = place;
      if (count < kLanes) continue;
      Weigh(changed);
      count = 0;
    }
    if (count > 0) Weigh(std::span(changed).first(count));
  });
  size_t count = 0;
  for (const int32_t place : touched_) {
    touched_[count] = place;
    count += marks_[static_cast<size_t>(place)];
    marks_[static_cast<size_t>(place)] = 0;
  }
  touched_.resize(count);
}

int32_t Stencils::KnownNeighbour(int32_t place) const {
  int32_t lowest = -1;
  for (const int32_t found : graph_.Neighbours(place)) {
    const int32_t other = std::max(found, ~found);
    const bool is_known =
        view_->visible.Has(other) && !std::binary_search(fresh_.begin(), fresh_.end(), other);
    if (is_known && (lowest < 0 || other < lowest)) lowest = other;
  }
  return lowest;
}

}  // namespace cleave
