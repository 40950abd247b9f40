#include "core/stream/stencils.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"

namespace cleave {
namespace {

constexpr size_t kEnoughNear = 7;          // places over one edge that make a search stop
constexpr size_t kEnough = kStencilNodes;  // places that make it stop farther out

// The nearest few of the places that it is offered, each once, by distance and then by place.
class Nearest {
 public:
  explicit Nearest(const Vec3& centre) : centre_(centre) {
    squares_.fill(std::numeric_limits<double>::infinity());
  }

  void Offer(int32_t place, const Vec3& position) {
    const double dx = position[0] - centre_[0];
    const double dy = position[1] - centre_[1];
    const double dz = position[2] - centre_[2];
    const double square = dx * dx + dy * dy + dz * dz;
    if (square <= squares_.back()) Insert(place, square);
  }

  void Clear() {
    count_ = 0;
    squares_.fill(std::numeric_limits<double>::infinity());
  }
  size_t count() const { return count_; }
  int32_t operator[](size_t at) const { return places_[at]; }

 private:
  void Insert(int32_t place, double square) {
    size_t at = count_;
    while (at > 0 &&
           (square < squares_[at - 1] || (square == squares_[at - 1] && place < places_[at - 1]))) {
      --at;
    }
    if (at == kStencilNodes || (at > 0 && places_[at - 1] == place)) return;
    if (count_ < kStencilNodes) ++count_;
    for (size_t to = count_ - 1; to > at; --to) {
      squares_[to] = squares_[to - 1];
      places_[to] = places_[to - 1];
    }
    squares_[at] = square;
    places_[at] = place;
  }

  Vec3 centre_;
  size_t count_ = 0;
  std::array<double, kStencilNodes> squares_;  // ascending; infinite behind the last
  std::array<int32_t, kStencilNodes> places_{};
};

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
  // Offers now those that were added and of which `is_wanted(place)`.
  template <typename IsWanted>
  void Flush(const IsWanted& is_wanted) {
    for (size_t at = 0; at < count_; ++at) {
      const int32_t place = places_[at];
      if (is_wanted(place)) nearest_.Offer(place, rest_[static_cast<size_t>(place)]);
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

// Offers the coarser places of the same piece in the 27 cubes around a place.
void SearchCubes(const CubeIndex& index, std::span<const NodeOrder::Coarse> coarser, uint64_t code,
                 int bits, int32_t piece, const Pieces& pieces, Candidates& candidates) {
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
  const auto same_piece = [&](int32_t place) { return pieces[place] == piece; };
  for (size_t at = 0; at < count; ++at) {
    for (const NodeOrder::Coarse& found : index.In(cubes[at], coarser)) {
      __builtin_prefetch(pieces.labels().data() + found.place);
      candidates.Add(found.place, true);
      if (!candidates.HasRoom()) candidates.Flush(same_piece);
    }
  }
  candidates.Flush(same_piece);
}

bool Contains(const Stencil& stencil, int32_t place) {
  bool contains = false;
  for (const int32_t of_stencil : stencil.places) contains |= of_stencil == place;
  return contains;
}

}  // namespace

Stencils::Stencils(const NodeOrder& order, std::vector<Vec3> rest_by_place,
                   std::span<const std::array<int32_t, 2>> edges)
    : rest_(std::move(rest_by_place)), graph_(order, edges) {
  stencils_.resize(rest_.size());
  reaches_.resize(rest_.size());
  is_touched_.assign(rest_.size(), 0);
  pieces_.Find(order, graph_);
  cubes_.resize(static_cast<size_t>(order.groups()));
  for (size_t group = 1; group < cubes_.size(); ++group) {
    for (size_t size = 0; size < kCubeSizes; ++size) {
      const int bits = order.cube_bits[group] + static_cast<int>(size);
      if (bits <= 21) cubes_[group][size] = CubeIndex(order.coarser[group], bits);
    }
  }
  ParallelFor(graph_.places(), 256, [&](int64_t begin, int64_t end) {
    for (int64_t place = begin; place < end; ++place) Rebuild(order, static_cast<int32_t>(place));
  });
}

void Stencils::Rebuild(const NodeOrder& order, int32_t place) {
  const auto index = static_cast<size_t>(place);
  const size_t group = order.GroupOf(place);
  const int32_t coarse_end = order.group_begins[group];
  Nearest nearest(rest_[index]);
  Candidates candidates(rest_, nearest);
  const auto any = [](int32_t) { return true; };
  // Breaks only take places away, so that a search never ends nearer than it did before.
  Reach& reach = reaches_[index];
  if (reach != Reach::kSpace) {
    for (const int32_t other : graph_.Neighbours(place)) {
      if (other >= coarse_end) break;  // ascending but for the broken ones, which are negative
      candidates.Add(other, other >= 0);
    }
    candidates.Flush(any);
    if (nearest.count() < kEnoughNear) reach = Reach::kTwoEdges;
  }
  if (reach == Reach::kTwoEdges) {
    for (const int32_t between : graph_.Neighbours(place)) {
      if (between >= 0) graph_.Prefetch(between);
    }
    // Places that came by lately, since most come by several times.
    std::array<int32_t, 64> recent;
    recent.fill(-1);
    for (const int32_t between : graph_.Neighbours(place)) {
      if (between < 0) continue;
      for (const int32_t other : graph_.Neighbours(between)) {
        if (other >= coarse_end) break;
        int32_t& same = recent[static_cast<size_t>(other) % recent.size()];
        candidates.Add(other, other >= 0 && same != other);
        same = other;
      }
    }
    candidates.Flush(any);
    if (nearest.count() < kEnough) reach = Reach::kSpace;
  }
  if (reach == Reach::kSpace) {
    nearest.Clear();
    for (size_t size = 0; size < kCubeSizes && nearest.count() < kEnough && group > 0; ++size) {
      const int bits = order.cube_bits[group] + static_cast<int>(size);
      if (bits > 21) break;
      SearchCubes(cubes_[group][size], order.coarser[group], order.codes[index], bits,
                  pieces_[place], pieces_, candidates);
    }
  }
  const int32_t leader = pieces_.leaders()[static_cast<size_t>(pieces_[place])];
  if (nearest.count() == 0 && leader != place) {
    nearest.Offer(leader, rest_[static_cast<size_t>(leader)]);
  }

  Stencil& stencil = stencils_[index];
  stencil.places.fill(nearest.count() > 0 ? nearest[0] : -1);
  stencil.weights.fill(0);
  if (nearest.count() == 0) return;
  std::array<Vec3, kStencilNodes> neighbours;
  for (size_t k = 0; k < nearest.count(); ++k) {
    stencil.places[k] = nearest[k];
    neighbours[k] = rest_[static_cast<size_t>(nearest[k])];
  }
  stencil.weights =
      StencilWeights(rest_[index], std::span<const Vec3>(neighbours.data(), nearest.count()));
}

void Stencils::Touch(int32_t place) {
  // Several threads may say so of one place.
  std::atomic_ref<uint8_t>(is_touched_[static_cast<size_t>(place)])
      .store(1, std::memory_order_relaxed);
}

// Breaks only take places out of a search's reach. So a stencil stays as it is while all of its
// places remain in reach, and only those that may have lost one are made anew.
void Stencils::TouchAround(int32_t edge) {
  const std::array<int32_t, 2> ends = graph_.Ends(edge);
  for (size_t side = 0; side < 2; ++side) {
    const int32_t near = ends[side];
    const int32_t far = ends[1 - side];
    const Reach reach = reaches_[static_cast<size_t>(near)];
    if (reach == Reach::kTwoEdges ||
        (reach == Reach::kOneEdge && Contains(stencils_[static_cast<size_t>(near)], far))) {
      Touch(near);
    }
    for (const int32_t other : graph_.Neighbours(near)) {
      // Stencils have earlier places only.
      if (other < far || reaches_[static_cast<size_t>(other)] != Reach::kTwoEdges) continue;
      if (Contains(stencils_[static_cast<size_t>(other)], far)) Touch(other);
    }
  }
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

const std::vector<int32_t>& Stencils::SetBroken(const NodeOrder& order,
                                                std::span<const int32_t> broken) {
  touched_.clear();
  if (std::equal(broken.begin(), broken.end(), broken_.begin(), broken_.end())) return touched_;
  if (!std::includes(broken.begin(), broken.end(), broken_.begin(), broken_.end())) {
    graph_.Heal();
    std::fill(reaches_.begin(), reaches_.end(), Reach::kOneEdge);
    for (const int32_t edge : broken) graph_.Break(edge);
    pieces_.Find(order, graph_);
    touched_.resize(rest_.size());
    std::iota(touched_.begin(), touched_.end(), 0);
  } else {
    std::vector<int32_t> fresh;
    std::set_difference(broken.begin(), broken.end(), broken_.begin(), broken_.end(),
                        std::back_inserter(fresh));
    for (const int32_t edge : fresh) graph_.Break(edge);
    ParallelFor(static_cast<int64_t>(fresh.size()), 256, [&](int64_t begin, int64_t end) {
      for (int64_t at = begin; at < end; ++at) TouchAround(fresh[static_cast<size_t>(at)]);
    });
    if (pieces_.Split(graph_, fresh)) TouchInSpace();
    for (size_t place = 0; place < is_touched_.size(); ++place) {
      if (is_touched_[place] != 0) touched_.push_back(static_cast<int32_t>(place));
      is_touched_[place] = 0;
    }
  }
  broken_.assign(broken.begin(), broken.end());
  ParallelFor(static_cast<int64_t>(touched_.size()), 64, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      Rebuild(order, touched_[at]);
    }
  });
  return touched_;
}

}  // namespace cleave
