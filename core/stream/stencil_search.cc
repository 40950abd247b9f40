// How Stencils of the state view finds the places of a stencil.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/base/lanes.h"
#include "core/base/parallel.h"
#include "core/stream/stencils.h"

namespace cleave {
namespace {

constexpr int64_t kAhead = 8;              // how far ahead that is fetched which will be read
constexpr size_t kEnoughNear = 7;          // places over one edge that make a search stop
constexpr size_t kEnough = kStencilNodes;  // places that make it stop farther out

// Places on their way to a Nearest: what is to be read of them is fetched meanwhile.
class Candidates {
 public:
  Candidates(std::span<const Vec3> rest, Nearest& nearest) : rest_(rest), nearest_(nearest) {}

  // Offers `place` sooner or later, if `wanted`.
  void Add(int32_t place, bool wanted) {
    __builtin_prefetch(rest_.data() + place);
    places_[count_] = place;
    count_ += static_cast<size_t>(wanted);
    if (count_ == places_.size()) Flush([](int32_t) { return true; });
  }
  // Offers those that were added and of which `is_wanted(place)`.
  template <typename IsWanted>
  void Flush(const IsWanted& is_wanted) {
    for (size_t at = 0; at < count_; ++at) {
      const int32_t place = places_[at];
      nearest_.Offer(place, rest_[static_cast<size_t>(place)], is_wanted(place));
    }
    count_ = 0;
  }
  bool HasRoom() const { return count_ + 1 < places_.size(); }

 private:
  std::span<const Vec3> rest_;
  Nearest& nearest_;
  size_t count_ = 0;
  std::array<int32_t, 256> places_;
};

bool ContainsAny(const Stencil& stencil, std::span<const int32_t> places) {
  Int32x8 of_stencil;
  std::memcpy(&of_stencil, stencil.places.data(), sizeof(of_stencil));
  Int32x8 found{};
  for (const int32_t place : places) found |= of_stencil == place;
  return Any(found);
}

}  // namespace

Stencils::Search Stencils::MakeSearch(const NodeOrder& order) const {
  Search search;
  search.cubes.resize(static_cast<size_t>(order.groups()));
  for (size_t group = 1; group < search.cubes.size(); ++group) {
    for (size_t size = 0; size < kCubeSizes; ++size) {
      const int bits = order.cube_bits[group] + static_cast<int>(size);
      if (bits <= kMortonBits) search.cubes[group][size] = CubeIndex(order.coarser[group], bits);
    }
  }
  search.reaches.resize(rest_.size());
  return search;
}

void Stencils::TouchAround(std::span<const int32_t> ends) {
  ParallelFor(static_cast<int64_t>(ends.size()), 64, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      if (at + kAhead < end) graph_.Prefetch(ends[static_cast<size_t>(at + kAhead)]);
      TouchAround(ends[static_cast<size_t>(at)]);
    }
  });
}

// Breaks only take places out of a search's reach. So a stencil stays as it is while all of its
// places remain in reach, and only those that may have lost one are made anew: here those that were
// found over an edge that `near` lost, or over one of its edges and then that.
void Stencils::TouchAround(int32_t near) {
  const auto touch = [&](std::span<const int32_t> lost) {
    const Reach reach = search_->reaches[static_cast<size_t>(near)];
    if (reach == kTwoEdges ||
        (reach == kOneEdge && ContainsAny(stencils_[static_cast<size_t>(near)], lost))) {
      Touch(near);
    }
    const int32_t first = *std::min_element(lost.begin(), lost.end());
    const std::span<const int32_t> ring = graph_.Neighbours(near);
    std::array<int32_t, 64> others;
    for (size_t begin = 0; begin < ring.size(); begin += others.size()) {
      size_t found = 0;
      for (const int32_t place :
           ring.subspan(begin, std::min(others.size(), ring.size() - begin))) {
        const auto index = static_cast<size_t>(std::max(place, 0));
        __builtin_prefetch(stencils_.data() + index);
        others[found] = place;
        // Stencils have earlier places only. Without branches, which nobody could predict.
        found += static_cast<size_t>((place >= first) & (search_->reaches[index] == kTwoEdges) &
                                     !IsTouched(std::max(place, 0)));
      }
      for (const int32_t other : std::span(others).first(found)) {
        if (ContainsAny(stencils_[static_cast<size_t>(other)], lost)) Touch(other);
      }
    }
  };
  std::array<int32_t, 64> lost;
  size_t count = 0;
  for (const int32_t other : graph_.Neighbours(near)) {
    // Edges between such places that were broken before make no difference.
    if (other >= 0 || lost_edges_[static_cast<size_t>(~other)] == 0) continue;
    lost[count++] = ~other;
    if (count < lost.size()) continue;
    touch(lost);
    count = 0;
  }
  if (count > 0) touch(std::span(lost.data(), count));
}

// Of stencils that were found in space, those with places that are now of another piece.
void Stencils::TouchInSpace() {
  ParallelFor(graph_.places(), 8192, [&](int64_t begin, int64_t end) {
    for (auto place = static_cast<int32_t>(begin); place < end; ++place) {
      if (search_->reaches[static_cast<size_t>(place)] >= kInSpace && LostPlaces(place)) {
        Touch(place);
      }
    }
  });
}

// The places that a place is to be predicted from.
void Stencils::SearchFor(const NodeOrder& order, int32_t place, Nearest& nearest) {
  const auto index = static_cast<size_t>(place);
  const size_t group = order.GroupOf(place);
  const int32_t coarse_end = order.group_begins[group];
  Candidates candidates(rest_, nearest);
  const auto any = [](int32_t) { return true; };
  // Breaks only take places away, so that a search never ends nearer than it did before.
  Reach& reach = search_->reaches[index];
  if (reach < kInSpace) {
    for (const int32_t other : graph_.Neighbours(place)) {
      if (other >= coarse_end) break;  // ascending but for the broken ones, which are negative
      candidates.Add(other, other >= 0);
    }
    candidates.Flush(any);
    if (nearest.count() < kEnoughNear) {
      reach = kTwoEdges;
    } else {
      nearest.Settle();
    }
  }
  if (reach == kTwoEdges) {
    for (const int32_t between : graph_.Neighbours(place)) {
      if (between >= 0) graph_.Prefetch(between);
    }
    // Places that came by lately, since most come by several times.
    std::array<int32_t, 512> recent;
    recent.fill(-1);
    for (size_t k = 0; k < nearest.count(); ++k) {
      recent[static_cast<size_t>(nearest[k]) % recent.size()] = nearest[k];
    }
    for (const int32_t between : graph_.Neighbours(place)) {
      if (between < 0) continue;
      for (const int32_t other : graph_.Neighbours(between)) {
        if (other >= coarse_end) break;
        int32_t& same = recent[static_cast<size_t>(other) % recent.size()];
        // Without branches, which nobody could predict.
        candidates.Add(other, (other >= 0) & (same != other));
        same = other;
      }
    }
    candidates.Flush(any);
    if (nearest.count() >= kEnough) nearest.Settle();
    if (nearest.count() < kEnough) reach = kInSpace;
  }
  if (reach >= kInSpace) {
    const int32_t piece = pieces_[place];
    const auto same_piece = [&](int32_t other) { return pieces_[other] == piece; };
    // What smaller cubes hold is in the larger ones too.
    for (size_t size = reach - kInSpace; group > 0; ++size) {
      const CubeIndex& cubes = search_->cubes[group][size];
      const bool is_largest = size + 1 == kCubeSizes || cubes.bits() == kMortonBits;
      reach = static_cast<Reach>(kInSpace + size);
      const CubesAround around(order.codes[index], cubes.bits());
      for (const CubesAround::Some& some : around.blocks()) cubes.Prefetch(some.block);
      std::array<std::span<const int32_t>, 27> found;
      size_t count = 0;
      size_t places = 0;
      for (const CubesAround::Some& some : around.blocks()) {
        cubes.ForCubes(some, [&](std::span<const int32_t> in_cube) {
          found[count++] = in_cube;
          places += in_cube.size();
          __builtin_prefetch(in_cube.data());
        });
      }
      if (places < kEnough && !is_largest) continue;
      nearest.Clear();
      for (const std::span<const int32_t> in_cube : std::span(found).first(count)) {
        for (const int32_t other : in_cube) {
          __builtin_prefetch(pieces_.labels().data() + other);
          candidates.Add(other, true);
          if (!candidates.HasRoom()) candidates.Flush(same_piece);
        }
      }
      candidates.Flush(same_piece);
      nearest.Settle();
      if (nearest.count() >= kEnough || is_largest) break;
    }
    if (group == 0) nearest.Clear();
  }
  const int32_t leader = LeaderOf(pieces_[place]);
  if (nearest.count() == 0 && leader != place) {
    nearest.Offer(leader, rest_[static_cast<size_t>(leader)], true);
  }
}

void Stencils::SearchForTouched(const NodeOrder& order) {
  constexpr int64_t kLanes = 4;
  const auto count = static_cast<int64_t>(touched_.size());
  ParallelFor((count + kLanes - 1) / kLanes, 16, [&](int64_t begin, int64_t end) {
    for (int64_t four = begin; four < end; ++four) {
      const int64_t first = four * kLanes;
      const auto places = std::span(touched_).subspan(
          static_cast<size_t>(first), static_cast<size_t>(std::min(kLanes, count - first)));
      for (const int32_t place : places) {
        Nearest nearest(rest_[static_cast<size_t>(place)]);
        SearchFor(order, place, nearest);
        Stencil& stencil = stencils_[static_cast<size_t>(place)];
        stencil.places.fill(nearest.count() > 0 ? nearest[0] : -1);
        for (size_t k = 0; k < nearest.count(); ++k) stencil.places[k] = nearest[k];
      }
      Weigh(places);
    }
  });
}

}  // namespace cleave
