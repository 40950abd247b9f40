#include "core/stream/stencils.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/mesh/morton.h"

namespace cleave {
namespace {

constexpr size_t kEnoughNear = 7;          // places over one edge that make a search stop
constexpr size_t kEnough = kStencilNodes;  // places that make it stop farther out
constexpr int kCubeSizes = 3;              // sizes of cube that are tried

// The nearest few of the places that it is offered, each once, by distance and then by place.
class Nearest {
 public:
  explicit Nearest(const Vec3& centre) : centre_(centre) {}

  void Offer(int32_t place, const Vec3& position) {
    const double dx = position[0] - centre_[0];
    const double dy = position[1] - centre_[1];
    const double dz = position[2] - centre_[2];
    const double square = dx * dx + dy * dy + dz * dz;
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

  void Clear() { count_ = 0; }
  size_t count() const { return count_; }
  int32_t operator[](size_t at) const { return places_[at]; }

 private:
  Vec3 centre_;
  size_t count_ = 0;
  std::array<double, kStencilNodes> squares_{};
  std::array<int32_t, kStencilNodes> places_{};
};

// Offers the coarser places of the same piece in the 27 cubes around a place.
void SearchCubes(const NodeOrder& order, size_t group, int32_t place, int bits,
                 const Pieces& pieces, const std::vector<Vec3>& rest, Nearest& nearest) {
  const std::vector<NodeOrder::Coarse>& coarser = order.coarser[group];
  const uint64_t code = order.codes[static_cast<size_t>(place)] >> (3 * bits);
  const std::array<int64_t, 3> cube = {static_cast<int64_t>(MortonCurve::Compact(code)),
                                       static_cast<int64_t>(MortonCurve::Compact(code >> 1)),
                                       static_cast<int64_t>(MortonCurve::Compact(code >> 2))};
  const int64_t cubes = int64_t{1} << (21 - bits);
  const int32_t piece = pieces[place];
  for (int64_t x = std::max<int64_t>(cube[0] - 1, 0); x <= std::min(cube[0] + 1, cubes - 1); ++x) {
    for (int64_t y = std::max<int64_t>(cube[1] - 1, 0); y <= std::min(cube[1] + 1, cubes - 1);
         ++y) {
      for (int64_t z = std::max<int64_t>(cube[2] - 1, 0); z <= std::min(cube[2] + 1, cubes - 1);
           ++z) {
        const uint64_t wanted = MortonCurve::Spread(static_cast<uint64_t>(x)) |
                                MortonCurve::Spread(static_cast<uint64_t>(y)) << 1 |
                                MortonCurve::Spread(static_cast<uint64_t>(z)) << 2;
        auto found = std::lower_bound(
            coarser.begin(), coarser.end(), wanted << (3 * bits),
            [](const NodeOrder::Coarse& item, uint64_t least) { return item.code < least; });
        for (; found != coarser.end() && found->code >> (3 * bits) == wanted; ++found) {
          if (pieces[found->place] == piece) {
            nearest.Offer(found->place, rest[static_cast<size_t>(found->place)]);
          }
        }
      }
    }
  }
}

bool Contains(const Stencil& stencil, int32_t place) {
  return std::find(stencil.places.begin(), stencil.places.end(), place) != stencil.places.end();
}

}  // namespace

Stencils::Stencils(const NodeOrder& order, std::vector<Vec3> rest_by_place,
                   std::span<const std::array<int32_t, 2>> edges)
    : rest_(std::move(rest_by_place)), graph_(order, edges) {
  stencils_.resize(rest_.size());
  reaches_.resize(rest_.size());
  is_touched_.assign(rest_.size(), 0);
  pieces_.Find(graph_);
  ParallelFor(graph_.places(), 256, [&](int64_t begin, int64_t end) {
    for (int64_t place = begin; place < end; ++place) Rebuild(order, static_cast<int32_t>(place));
  });
}

void Stencils::Rebuild(const NodeOrder& order, int32_t place) {
  const auto index = static_cast<size_t>(place);
  const size_t group = order.GroupOf(place);
  const int32_t coarse_end = order.group_begins[group];
  Nearest nearest(rest_[index]);
  Reach reach = Reach::kOneEdge;
  for (const int32_t other : graph_.Neighbours(place)) {
    if (other >= coarse_end) break;  // ascending but for the broken ones, which are negative
    if (other >= 0) nearest.Offer(other, rest_[static_cast<size_t>(other)]);
  }
  if (nearest.count() < kEnoughNear) {
    reach = Reach::kTwoEdges;
    for (const int32_t between : graph_.Neighbours(place)) {
      if (between < 0) continue;
      for (const int32_t other : graph_.Neighbours(between)) {
        if (other >= coarse_end) break;
        if (other >= 0) nearest.Offer(other, rest_[static_cast<size_t>(other)]);
      }
    }
  }
  if (reach == Reach::kTwoEdges && nearest.count() < kEnough) {
    reach = Reach::kSpace;
    nearest.Clear();
    const int bits = order.cube_bits[group];
    for (int size = 0; size < kCubeSizes && nearest.count() < kEnough; ++size) {
      if (bits + size > 21) break;
      SearchCubes(order, group, place, bits + size, pieces_, rest_, nearest);
    }
  }
  const int32_t leader = pieces_.leaders()[static_cast<size_t>(pieces_[place])];
  if (nearest.count() == 0 && leader != place) {
    nearest.Offer(leader, rest_[static_cast<size_t>(leader)]);
  }

  Stencil& stencil = stencils_[index];
  stencil.places.fill(nearest.count() > 0 ? nearest[0] : -1);
  stencil.weights.fill(0);
  reaches_[index] = reach;
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
  uint8_t& touched = is_touched_[static_cast<size_t>(place)];
  if (touched != 0) return;
  touched = 1;
  touched_.push_back(place);
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
      if (other < 0 || reaches_[static_cast<size_t>(other)] != Reach::kTwoEdges) continue;
      if (Contains(stencils_[static_cast<size_t>(other)], far)) Touch(other);
    }
  }
}

const std::vector<int32_t>& Stencils::SetBroken(const NodeOrder& order,
                                                std::span<const int32_t> broken) {
  touched_.clear();
  if (std::equal(broken.begin(), broken.end(), broken_.begin(), broken_.end())) return touched_;
  if (!std::includes(broken.begin(), broken.end(), broken_.begin(), broken_.end())) {
    graph_.Heal();
    for (const int32_t edge : broken) graph_.Break(edge);
    pieces_.Find(graph_);
    touched_.resize(rest_.size());
    std::iota(touched_.begin(), touched_.end(), 0);
  } else {
    std::vector<int32_t> fresh;
    std::set_difference(broken.begin(), broken.end(), broken_.begin(), broken_.end(),
                        std::back_inserter(fresh));
    for (const int32_t edge : fresh) graph_.Break(edge);
    for (const int32_t edge : fresh) TouchAround(edge);
    if (pieces_.Split(graph_, fresh)) {
      for (int32_t place = 0; place < graph_.places(); ++place) {
        if (reaches_[static_cast<size_t>(place)] != Reach::kSpace) continue;
        const Stencil& stencil = stencils_[static_cast<size_t>(place)];
        if (stencil.leads()) continue;
        for (const int32_t other : stencil.places) {
          if (pieces_[other] != pieces_[place]) Touch(place);
        }
      }
    }
  }
  broken_.assign(broken.begin(), broken.end());
  ParallelFor(static_cast<int64_t>(touched_.size()), 64, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      Rebuild(order, touched_[at]);
    }
  });
  for (const int32_t place : touched_) is_touched_[static_cast<size_t>(place)] = 0;
  return touched_;
}

}  // namespace cleave
