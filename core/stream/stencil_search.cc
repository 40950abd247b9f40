// How Stencils finds the places of a stencil.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "core/base/parallel.h"
#include "core/stream/stencils.h"

namespace cleave {
namespace {

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

// In the state view.
constexpr auto kAllVisible = [](int32_t) { return true; };

}  // namespace

// The places that a place is to be predicted from.
template <typename IsVisible>
void Stencils::Search(const NodeOrder& order, int32_t place, Nearest& nearest,
                      IsVisible is_visible) {
  const auto index = static_cast<size_t>(place);
  const size_t group = order.GroupOf(place);
  const int32_t coarse_end = order.group_begins[group];
  Candidates candidates(rest_, nearest);
  const auto any = [](int32_t) { return true; };
  // Breaks only take places away, so that a search never ends nearer than it did before.
  Reach& reach = reaches_[index];
  if (reach < kInSpace) {
    for (const int32_t other : graph_.Neighbours(place)) {
      if (other >= coarse_end) break;  // ascending but for the broken ones, which are negative
      candidates.Add(other, other >= 0 && is_visible(other));
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
        const bool is_new = (other >= 0) & (same != other);
        candidates.Add(other, is_new & is_visible(std::max(other, 0)));
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
      const CubeIndex& cubes = cubes_[group][size];
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

void Stencils::Rebuild(const NodeOrder& order, std::span<const int32_t> places) {
  if (visible_) {
    // By value, so that nothing that is written can change where it reads.
    const uint8_t* const visible = visible_->marks().data();
    Rebuild(order, places, [visible](int32_t place) { return visible[place] != 0; });
  } else {
    Rebuild(order, places, kAllVisible);
  }
}

template <typename IsVisible>
void Stencils::Rebuild(const NodeOrder& order, std::span<const int32_t> places,
                       const IsVisible& is_visible) {
  constexpr int64_t kLanes = 4;
  constexpr bool kInView = !std::is_same_v<IsVisible, std::remove_cvref_t<decltype(kAllVisible)>>;
  const auto rebuild_four = [&](std::span<const int32_t> some) {
    StencilBatch batch;
    for (size_t lane = 0; lane < some.size(); ++lane) {
      const auto index = static_cast<size_t>(some[lane]);
      const Vec3& centre = rest_[index];
      Nearest nearest(centre);
      Search(order, some[lane], nearest, is_visible);
      const size_t count = nearest.count();
      batch.counts[static_cast<int>(lane)] = static_cast<int32_t>(count);
      if constexpr (kInView) {
        far_squares_[index] = count < kStencilNodes ? std::numeric_limits<double>::infinity()
                                                    : nearest.Square(count - 1);
      }
      Stencil& stencil = stencils_[index];
      stencil.places.fill(count > 0 ? nearest[0] : -1);
      for (size_t k = 0; k < count; ++k) {
        stencil.places[k] = nearest[k];
        const Vec3& neighbour = rest_[static_cast<size_t>(nearest[k])];
        for (size_t axis = 0; axis < 3; ++axis) {
          batch.offsets[k][axis][static_cast<int>(lane)] = neighbour[axis] - centre[axis];
        }
      }
    }
    const std::array<Int32x4, kStencilNodes> weights = StencilWeights(batch);
    for (size_t lane = 0; lane < some.size(); ++lane) {
      Stencil& stencil = stencils_[static_cast<size_t>(some[lane])];
      const bool leads = stencil.leads();
      for (size_t k = 0; k < kStencilNodes; ++k) {
        stencil.weights[k] = leads ? 0 : weights[k][static_cast<int>(lane)];
      }
    }
  };
  const auto count = static_cast<int64_t>(places.size());
  ParallelFor((count + kLanes - 1) / kLanes, 16, [&](int64_t begin, int64_t end) {
    for (int64_t four = begin; four < end; ++four) {
      const int64_t first = four * kLanes;
      rebuild_four(places.subspan(static_cast<size_t>(first),
                                  static_cast<size_t>(std::min(kLanes, count - first))));
    }
  });
}

}  // namespace cleave
