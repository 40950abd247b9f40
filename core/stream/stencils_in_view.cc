// What is apart in Stencils of a surface view.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>

#include "core/base/parallel.h"
#include "core/stream/stencils.h"

namespace cleave {
namespace {

constexpr uint8_t kFresh = 1;
constexpr uint8_t kDone = 2;  // TouchRing, of what is next to fresh places
constexpr size_t kRoom = 64;
constexpr size_t kAhead = 8;  // how many places on what will be read is fetched

}  // namespace

void Stencils::FindLeaders() {
  leaders_.clear();
  leader_of_.assign(static_cast<size_t>(pieces_.count()), -1);
  for (const int32_t place : visible_->places()) {
    int32_t& leader = leader_of_[static_cast<size_t>(pieces_[place])];
    if (leader >= 0) continue;
    leader = place;
    leaders_.push_back(place);
  }
}

// Lets searches in space find these places, which are ascending.
void Stencils::ShowInCubes(const NodeOrder& order, std::span<const int32_t> places) {
  const auto tables = static_cast<int64_t>(cubes_.size() * kCubeSizes);
  ParallelFor(tables, 1, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      CubeIndex& cubes = cubes_[at / kCubeSizes][at % kCubeSizes];
      if (cubes.empty()) continue;
      const int32_t coarse_end = order.group_begins[at / kCubeSizes];
      const auto code = [&](size_t k) { return order.codes[static_cast<size_t>(places[k])]; };
      const auto count = static_cast<size_t>(
          std::lower_bound(places.begin(), places.end(), coarse_end) - places.begin());
      for (size_t k = 0; k < count; ++k) {
        if (k + kAhead < count) cubes.PrefetchOf(code(k + kAhead));
        cubes.Add(code(k), places[k]);
      }
    }
  });
}

// A place that comes into view can be nearer to others than what they have. Those that may take it
// are searched for anew: here those over one edge or two, if that is how far their search went and
// it is nearer, or if it went farther. No piece is looked at. Also makes what
// TouchInCubesOfFresh needs.
void Stencils::TouchRoundFresh(const NodeOrder& order) {
  if (fresh_.empty()) return;
  const auto tables = static_cast<int64_t>(cubes_.size() * kCubeSizes);
  ParallelFor(tables, 1, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const CubeIndex& cubes = cubes_[at / kCubeSizes][at % kCubeSizes];
      CubeSet& near = near_fresh_[at / kCubeSizes][at % kCubeSizes];
      near.Clear(cubes.bits());
      if (cubes.empty()) continue;
      const int32_t coarse_end = order.group_begins[at / kCubeSizes];
      for (const int32_t place : fresh_) {
        if (place >= coarse_end) break;
        near.Add(order.codes[static_cast<size_t>(place)] >> (3 * cubes.bits()));
      }
      near.Widen();
    }
  });
  for (const int32_t place : fresh_) {
    marks_[static_cast<size_t>(place)] = kFresh;
    Touch(place, kSearchAnew);
  }
  ParallelFor(static_cast<int64_t>(fresh_.size()), 64, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      if (at + 1 < end) {
        for (const int32_t place : graph_.Neighbours(fresh_[static_cast<size_t>(at + 1)])) {
          graph_.Prefetch(std::max(place, 0));
        }
      }
      for (const int32_t place : graph_.Neighbours(fresh_[static_cast<size_t>(at)])) {
        if (place < 0) continue;
        const std::atomic_ref<uint8_t> mark(marks_[static_cast<size_t>(place)]);
        if ((mark.load(std::memory_order_relaxed) & kDone) != 0) continue;
        if ((mark.fetch_or(kDone, std::memory_order_relaxed) & kDone) == 0) TouchRing(place);
      }
    }
  });
  std::fill(marks_.begin(), marks_.end(), uint8_t{0});
}

// Those that were found in space: where `splits` says that a piece split, those that lost places to
// another; and in cubes that fresh places touch, those of pieces that have some; also those that
// found one place alone, since that may be what led their piece before.
void Stencils::TouchInSpaceInView(const NodeOrder& order, bool splits) {
  std::vector<uint8_t> has_fresh(static_cast<size_t>(pieces_.count()), 0);
  for (const int32_t place : fresh_) has_fresh[static_cast<size_t>(pieces_[place])] = 1;
  const std::vector<int32_t>& places = visible_->places();
  ParallelFor(static_cast<int64_t>(places.size()), 4096, [&](int64_t begin, int64_t end) {
    size_t group = order.GroupOf(places[static_cast<size_t>(begin)]);
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const int32_t place = places[at];
      const auto index = static_cast<size_t>(place);
      while (place >= order.group_begins[group + 1]) ++group;
      if (reaches_[index] < kInSpace || ChangeOf(place) >= kSearchInSpace) continue;
      if (splits && LostPlaces(place)) Touch(place, kSearch);
      if (has_fresh[static_cast<size_t>(pieces_[place])] == 0) continue;
      const size_t size = reaches_[index] - kInSpace;
      const uint64_t cube = order.codes[index] >> (3 * cubes_[group][size].bits());
      const Stencil& stencil = stencils_[index];
      if (stencil.places[1] == stencil.places[0] || near_fresh_[group][size].Has(cube)) {
        Touch(place, kSearchInSpace);
      }
    }
  });
}

// A place with fresh ones next to it, that is over an unbroken edge: of it and of all that is next
// to it, what the fresh ones are near enough to.
void Stencils::TouchRing(int32_t between) {
  const std::span<const int32_t> ring = graph_.Neighbours(between);
  std::array<int32_t, kRoom> fresh;
  size_t count = 0;
  for (const int32_t place : ring) {
    const auto index = static_cast<size_t>(std::max(place, 0));
    const uint8_t mark = std::atomic_ref(marks_[index]).load(std::memory_order_relaxed);
    fresh[count] = place;  // without branches, which nobody could predict
    count += static_cast<size_t>((place >= 0) & ((mark & kFresh) != 0));
    if (count == kRoom) break;
  }
  const bool are_all = count < kRoom;
  const auto one_is_near = [&](int32_t place) {
    const double reach = far_squares_[static_cast<size_t>(place)];
    if (!are_all) return true;
    const Vec3& centre = rest_[static_cast<size_t>(place)];
    for (size_t k = 0; k < count && fresh[k] < place; ++k) {
      const Vec3& x = rest_[static_cast<size_t>(fresh[k])];
      const double dx = x[0] - centre[0];
      const double dy = x[1] - centre[1];
      const double dz = x[2] - centre[2];
      if (dx * dx + dy * dy + dz * dz <= reach) return true;
    }
    return false;
  };
  // Whether the search for it stopped before it came as far as fresh places are, at most `edges`.
  const auto touch = [&](int32_t place, Reach edges) {
    if (reaches_[static_cast<size_t>(place)] > edges || one_is_near(place)) {
      Touch(place, kSearchAnew);
    }
  };
  if (between > fresh[0] && visible_->Has(between) && ChangeOf(between) != kSearchAnew) {
    touch(between, kOneEdge);
  }
  // Hidden places have no reach.
  std::array<int32_t, kRoom> others;
  for (size_t begin = 0; begin < ring.size(); begin += kRoom) {
    size_t found = 0;
    for (const int32_t place : ring.subspan(begin, std::min(kRoom, ring.size() - begin))) {
      const int32_t other = std::max(place, 0);
      others[found] = place;
      found += static_cast<size_t>((place > fresh[0]) &
                                   (reaches_[static_cast<size_t>(other)] >= kTwoEdges) &
                                   (ChangeOf(other) != kSearchAnew));
    }
    for (size_t at = 0; at < found; ++at) touch(others[at], kTwoEdges);
  }
}

int32_t Stencils::KnownNeighbour(int32_t place) const {
  int32_t lowest = -1;
  for (const int32_t found : graph_.Neighbours(place)) {
    const int32_t other = std::max(found, ~found);
    const bool is_known =
        visible_->Has(other) && !std::binary_search(fresh_.begin(), fresh_.end(), other);
    if (is_known && (lowest < 0 || other < lowest)) lowest = other;
  }
  return lowest;
}

}  // namespace cleave
