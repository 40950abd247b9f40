#include "core/stream/stencils.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/lanes.h"
#include "core/base/parallel.h"

namespace cleave {
namespace {

constexpr size_t kEnoughNear = 7;          // places over one edge that make a search stop
constexpr size_t kEnough = kStencilNodes;  // places that make it stop farther out

// Places on their way to a Nearest: what is to be read of them is fetched meanwhile.
class Candidates {
 public:
  Candidates(const std::vector<Vec3>& rest, Nearest& nearest) : rest_(rest), nearest_(nearest) {}

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
  const std::vector<Vec3>& rest_;
  Nearest& nearest_;
  size_t count_ = 0;
  std::array<int32_t, 256> places_;
};

// Offers the coarser visible places of the same piece in the 27 cubes around a place.
template <typename IsVisible>
void SearchCubes(const CubeIndex& index, std::span<const NodeOrder::Coarse> coarser, uint64_t code,
                 int bits, int32_t piece, const Pieces& pieces, const IsVisible& is_visible,
                 Candidates& candidates) {
  // Neighbouring cubes by arithmetic on each axis' bits in place.
  constexpr uint64_t kX = 0x1249249249249249u;
  const uint64_t inside = (uint64_t{1} << (3 * (21 - bits))) - 1;
  const uint64_t cube = code >> (3 * bits);
  std::array<std::array<uint64_t, 3>, 3> along;  // by axis
  std::array<size_t, 3> counts{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const uint64_t mask = (kX << axis) & inside;
    const uint64_t own = cube & mask;
    const uint64_t one = uint64_t{1} << axis;
    if (own != 0) along[axis][counts[axis]++] = (own - one) & mask;
    along[axis][counts[axis]++] = own;
    if (own != mask) along[axis][counts[axis]++] = ((own | ~mask) + one) & mask;
  }
  std::array<uint64_t, 27> cubes;
  size_t count = 0;
  for (size_t x = 0; x < counts[0]; ++x) {
    for (size_t y = 0; y < counts[1]; ++y) {
      for (size_t z = 0; z < counts[2]; ++z) {
        cubes[count] = along[0][x] | along[1][y] | along[2][z];
        index.Prefetch(cubes[count++]);
      }
    }
  }
  const auto same_piece = [&](int32_t place) {
    return pieces[place] == piece && is_visible(place);
  };
  for (size_t at = 0; at < count; ++at) {
    for (const NodeOrder::Coarse& found : index.In(cubes[at], coarser)) {
      __builtin_prefetch(pieces.labels().data() + found.place);
      candidates.Add(found.place, true);
      if (!candidates.HasRoom()) candidates.Flush(same_piece);
    }
  }
  candidates.Flush(same_piece);
}

// In the state view.
constexpr auto kAllVisible = [](int32_t) { return true; };

bool ContainsAny(const Stencil& stencil, std::span<const int32_t> places) {
  Int32x8 of_stencil;
  std::memcpy(&of_stencil, stencil.places.data(), sizeof(of_stencil));
  Int32x8 found{};
  for (const int32_t place : places) found |= of_stencil == place;
  return Any(found);
}

}  // namespace

Stencils::Stencils(const NodeOrder& order, std::vector<Vec3> rest_by_place,
                   std::span<const std::array<int32_t, 2>> edges,
                   std::optional<VisiblePlaces> visible)
    : rest_(std::move(rest_by_place)), graph_(order, edges), visible_(std::move(visible)) {
  stencils_.resize(rest_.size());
  reaches_.resize(rest_.size());
  lost_edges_.assign(rest_.size(), 0);
  is_touched_.assign(rest_.size(), 0);
  pieces_.Find(order, graph_);
  cubes_.resize(static_cast<size_t>(order.groups()));
  for (size_t group = 1; group < cubes_.size(); ++group) {
    for (size_t size = 0; size < kCubeSizes; ++size) {
      const int bits = order.cube_bits[group] + static_cast<int>(size);
      if (bits <= 21) cubes_[group][size] = CubeIndex(order.coarser[group], bits);
    }
  }
  TouchAll();
  Rebuild(order, touched_);
}

Stencils::Stencils(const NodeOrder& order, std::vector<Vec3> rest_by_place,
                   std::span<const std::array<int32_t, 2>> edges)
    : Stencils(order, std::move(rest_by_place), edges, std::nullopt) {}

Stencils::Stencils(const NodeOrder& order, std::vector<Vec3> rest_by_place, const StreamMesh& mesh)
    : Stencils(order, std::move(rest_by_place), mesh.edges,
               VisiblePlaces(order, mesh.edges, mesh.tets)) {}

// The places that a place is to be predicted from.
template <typename IsVisible>
void Stencils::Search(const NodeOrder& order, int32_t place, Nearest& nearest,
                      const IsVisible& is_visible) {
  const auto index = static_cast<size_t>(place);
  const size_t group = order.GroupOf(place);
  const int32_t coarse_end = order.group_begins[group];
  Candidates candidates(rest_, nearest);
  const auto any = [](int32_t) { return true; };
  // Breaks only take places away, so that a search never ends nearer than it did before.
  Reach& reach = reaches_[index];
  if (reach != Reach::kSpace) {
    for (const int32_t other : graph_.Neighbours(place)) {
      if (other >= coarse_end) break;  // ascending but for the broken ones, which are negative
      candidates.Add(other, other >= 0 && is_visible(other));
    }
    candidates.Flush(any);
    nearest.Settle();
    if (nearest.count() < kEnoughNear) reach = Reach::kTwoEdges;
  }
  if (reach == Reach::kTwoEdges) {
    for (const int32_t between : graph_.Neighbours(place)) {
      if (between >= 0) graph_.Prefetch(between);
    }
    // Places that came by lately, since most come by several times.
    std::array<int32_t, 128> recent;
    recent.fill(-1);
    for (size_t k = 0; k < nearest.count(); ++k) {
      recent[static_cast<size_t>(nearest[k]) % recent.size()] = nearest[k];
    }
    for (const int32_t between : graph_.Neighbours(place)) {
      if (between < 0) continue;
      for (const int32_t other : graph_.Neighbours(between)) {
        if (other >= coarse_end) break;
        int32_t& same = recent[static_cast<size_t>(other) % recent.size()];
        candidates.Add(other, other >= 0 && same != other && is_visible(other));
        same = other;
      }
    }
    candidates.Flush(any);
    nearest.Settle();
    if (nearest.count() < kEnough) reach = Reach::kSpace;
  }
  if (reach == Reach::kSpace) {
    nearest.Clear();
    for (size_t size = 0; size < kCubeSizes && nearest.count() < kEnough && group > 0; ++size) {
      const int bits = order.cube_bits[group] + static_cast<int>(size);
      if (bits > 21) break;
      SearchCubes(cubes_[group][size], order.coarser[group], order.codes[index], bits,
                  pieces_[place], pieces_, is_visible, candidates);
      nearest.Settle();
    }
  }
  const int32_t leader = LeaderOf(pieces_[place]);
  if (nearest.count() == 0 && leader != place) {
    nearest.Offer(leader, rest_[static_cast<size_t>(leader)], true);
  }
}

void Stencils::Rebuild(const NodeOrder& order, std::span<const int32_t> places) {
  if (visible_) {
    Rebuild(order, places, [this](int32_t place) { return visible_->Has(place); });
  } else {
    Rebuild(order, places, kAllVisible);
  }
}

template <typename IsVisible>
void Stencils::Rebuild(const NodeOrder& order, std::span<const int32_t> places,
                       const IsVisible& is_visible) {
  constexpr int64_t kLanes = 4;
  const auto rebuild_four = [&](std::span<const int32_t> some) {
    StencilBatch batch;
    for (size_t lane = 0; lane < some.size(); ++lane) {
      const auto index = static_cast<size_t>(some[lane]);
      const Vec3& centre = rest_[index];
      Nearest nearest(centre);
      Search(order, some[lane], nearest, is_visible);
      const size_t count = nearest.count();
      batch.counts[static_cast<int>(lane)] = static_cast<int32_t>(count);
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

void Stencils::Touch(int32_t place) {
  // Several threads may say so of one place.
  std::atomic_ref<uint8_t>(is_touched_[static_cast<size_t>(place)])
      .store(1, std::memory_order_relaxed);
}

// Breaks only take places out of a search's reach. So a stencil stays as it is while all of its
// places remain in reach, and only those that may have lost one are made anew: here those that were
// found over an edge that `near` lost, or over one of its edges and then that.
void Stencils::TouchAround(int32_t near) {
  const auto touch = [&](std::span<const int32_t> lost) {
    const Reach reach = reaches_[static_cast<size_t>(near)];
    if (reach == Reach::kTwoEdges ||
        (reach == Reach::kOneEdge && ContainsAny(stencils_[static_cast<size_t>(near)], lost))) {
      Touch(near);
    }
    const int32_t first = *std::min_element(lost.begin(), lost.end());
    for (const int32_t other : graph_.Neighbours(near)) {
      // Stencils have earlier places only.
      if (other < first || reaches_[static_cast<size_t>(other)] != Reach::kTwoEdges) continue;
      if (ContainsAny(stencils_[static_cast<size_t>(other)], lost)) Touch(other);
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
      const int32_t piece = pieces_[place];
      if (reaches_[static_cast<size_t>(place)] != Reach::kSpace || !pieces_.IsNew(piece)) continue;
      const Stencil& stencil = stencils_[static_cast<size_t>(place)];
      if (stencil.leads()) continue;
      for (const int32_t other : stencil.places) {
        if (pieces_[other] != piece) Touch(place);
      }
    }
  });
}

void Stencils::TouchAll() {
  if (visible_) {
    FindLeaders();
    touched_ = visible_->places();
  } else {
    touched_.resize(rest_.size());
    std::iota(touched_.begin(), touched_.end(), 0);
  }
}

const std::vector<int32_t>& Stencils::SetBroken(const NodeOrder& order,
                                                std::span<const int32_t> broken) {
  touched_.clear();
  fresh_.clear();
  if (std::equal(broken.begin(), broken.end(), broken_.begin(), broken_.end())) return touched_;
  if (!std::includes(broken.begin(), broken.end(), broken_.begin(), broken_.end())) {
    graph_.Heal();
    std::fill(reaches_.begin(), reaches_.end(), Reach::kOneEdge);
    for (const int32_t edge : broken) graph_.Break(edge);
    pieces_.Find(order, graph_);
    if (visible_) {
      visible_->Heal();
      fresh_ = visible_->Break(graph_, broken);
    }
    TouchAll();
  } else {
    std::vector<int32_t> fresh;
    std::set_difference(broken.begin(), broken.end(), broken_.begin(), broken_.end(),
                        std::back_inserter(fresh));
    std::vector<int32_t> ends;
    for (const int32_t edge : fresh) {
      graph_.Break(edge);
      for (const int32_t end : graph_.Ends(edge)) {
        uint8_t& lost_edges = lost_edges_[static_cast<size_t>(end)];
        if (lost_edges == 0) ends.push_back(end);
        lost_edges = 1;
      }
    }
    ParallelFor(static_cast<int64_t>(ends.size()), 64, [&](int64_t begin, int64_t end) {
      for (int64_t at = begin; at < end; ++at) TouchAround(ends[static_cast<size_t>(at)]);
    });
    for (const int32_t end : ends) lost_edges_[static_cast<size_t>(end)] = 0;
    if (pieces_.Split(graph_, fresh)) TouchInSpace();
    if (visible_) {
      fresh_ = visible_->Break(graph_, fresh);
      FindLeaders();
      TouchRoundFresh();
    }
    for (size_t place = 0; place < is_touched_.size(); ++place) {
      const bool counts = !visible_ || visible_->Has(static_cast<int32_t>(place));
      if (is_touched_[place] != 0 && counts) touched_.push_back(static_cast<int32_t>(place));
      is_touched_[place] = 0;
    }
  }
  broken_.assign(broken.begin(), broken.end());
  Rebuild(order, touched_);
  return touched_;
}

}  // namespace cleave
