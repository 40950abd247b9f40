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
constexpr uint8_t kNextToFresh = 2;

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
      for (const int32_t place : places) {
        if (place >= coarse_end) break;
        cubes.Add(order.codes[static_cast<size_t>(place)], place);
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
  ParallelFor(static_cast<int64_t>(fresh_.size()), 256, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      for (const int32_t place : graph_.Neighbours(fresh_[static_cast<size_t>(at)])) {
        if (place < 0) continue;
        const std::atomic_ref<uint8_t> mark(marks_[static_cast<size_t>(place)]);
        if ((mark.load(std::memory_order_relaxed) & kNextToFresh) == 0) {
          mark.fetch_or(kNextToFresh, std::memory_order_relaxed);
        }
      }
    }
  });
  std::vector<int32_t> marked;
  ListMarked(marks_, marked);
  ParallelFor(static_cast<int64_t>(marked.size()), 64, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      const int32_t place = marked[static_cast<size_t>(at)];
      if ((marks_[static_cast<size_t>(place)] & kNextToFresh) != 0) TouchRing(place);
    }
  });
  std::fill(marks_.begin(), marks_.end(), uint8_t{0});
}

// And those that were found in space, in cubes that fresh places touch, of pieces that have some;
// also those that found one place alone, since that may be what led their piece before.
void Stencils::TouchInCubesOfFresh(const NodeOrder& order) {
  if (fresh_.empty()) return;
  std::vector<uint8_t> has_fresh(static_cast<size_t>(pieces_.count()), 0);
  for (const int32_t place : fresh_) has_fresh[static_cast<size_t>(pieces_[place])] = 1;
  const std::vector<int32_t>& places = visible_->places();
  ParallelFor(static_cast<int64_t>(places.size()), 4096, [&](int64_t begin, int64_t end) {
    size_t group = order.GroupOf(places[static_cast<size_t>(begin)]);
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const auto place = static_cast<size_t>(places[at]);
      while (places[at] >= order.group_begins[group + 1]) ++group;
      if (reaches_[place] < kInSpace || has_fresh[static_cast<size_t>(pieces_[places[at]])] == 0) {
        continue;
      }
      const size_t size = reaches_[place] - kInSpace;
      const uint64_t cube = order.codes[place] >> (3 * cubes_[group][size].bits());
      const Stencil& stencil = stencils_[place];
      if (stencil.places[1] == stencil.places[0] || near_fresh_[group][size].Has(cube)) {
        Touch(places[at], kSearchInSpace);
      }
    }
  });
}

// A place with fresh ones next to it, that is over an unbroken edge: of it and of all that is next
// to it, what the fresh ones are near enough to.
void Stencils::TouchRing(int32_t between) {
  const std::span<const int32_t> ring = graph_.Neighbours(between);
  std::array<int32_t, 64> fresh{};
  size_t count = 0;
  for (const int32_t place : ring) {
    if (place < 0 || (marks_[static_cast<size_t>(place)] & kFresh) == 0) continue;
    fresh[count++] = place;
    if (count == fresh.size()) break;
  }
  const bool are_all = count < fresh.size();
  const auto square = [&](int32_t from, int32_t to) {
    const Vec3& a = rest_[static_cast<size_t>(from)];
    const Vec3& b = rest_[static_cast<size_t>(to)];
    const double dx = b[0] - a[0];
    const double dy = b[1] - a[1];
    const double dz = b[2] - a[2];
    return dx * dx + dy * dy + dz * dz;
  };
  const auto one_is_near = [&](int32_t place) {
    const Stencil& stencil = stencils_[static_cast<size_t>(place)];
    const int32_t last = stencil.places.back();
    if (last == stencil.places[0] || !are_all) return true;  // there is room for more
    const double reach = square(place, last);
    for (size_t k = 0; k < count && fresh[k] < place; ++k) {
      if (square(place, fresh[k]) <= reach) return true;
    }
    return false;
  };
  // Whether the search for it stopped before it came as far as fresh places are, at most `edges`.
  const auto touch = [&](int32_t place, Reach edges) {
    const auto index = static_cast<size_t>(place);
    if (place <= fresh[0] || !visible_->Has(place) || reaches_[index] < edges) return;
    const std::atomic_ref<Change> change(changes_[index]);
    if (change.load(std::memory_order_relaxed) == kSearchAnew) return;
    if (reaches_[index] > edges || one_is_near(place)) Touch(place, kSearchAnew);
  };
  touch(between, kOneEdge);
  for (const int32_t place : ring) {
    if (place >= 0) touch(place, kTwoEdges);
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
