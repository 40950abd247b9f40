#include "core/stream/interpolation_predictor.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "core/base/run_both.h"

namespace cleave {
namespace {

std::vector<Vec3> ByPlace(const NodeOrder& order, std::span<const Vec3> positions) {
  std::vector<Vec3> by_place(positions.size());
  for (size_t place = 0; place < by_place.size(); ++place) {
    by_place[place] = positions[static_cast<size_t>(order.nodes[place])];
  }
  return by_place;
}

int32_t Within(int64_t value) {
  return static_cast<int32_t>(std::clamp(value, int64_t{-kMaxQuantised}, int64_t{kMaxQuantised}));
}

}  // namespace

InterpolationPredictor::InterpolationPredictor(const StreamHeader& header, const StreamMesh& mesh)
    : order_(MakeNodeOrder(mesh.rest_positions)),
      stencils_(header.is_surface()
                    ? Stencils(order_, ByPlace(order_, mesh.rest_positions), mesh)
                    : Stencils(order_, ByPlace(order_, mesh.rest_positions), mesh.edges)),
      origin_(header.origin),
      domain_bound_(header.domain_bound) {
  for (LargeVector<Int32x4>* lanes : {&positions_, &next_, &last_, &before_, &at_rest_}) {
    lanes->resize(mesh.rest_positions.size());
  }
  if (header.is_surface()) return;
  all_places_.resize(mesh.rest_positions.size());
  std::iota(all_places_.begin(), all_places_.end(), 0);
}

std::span<const int32_t> InterpolationPredictor::PlacesWithin(int64_t first, int64_t count) const {
  const std::vector<int32_t>& all = places();
  if (!stencils_.visible()) {
    return std::span(all).subspan(static_cast<size_t>(first), static_cast<size_t>(count));
  }
  const auto begin = std::lower_bound(all.begin(), all.end(), first);
  return {begin, std::lower_bound(begin, all.end(), first + count)};
}

// Where places that have come into view were when nobody saw them, by how they lie among others at
// rest: those that lead, which need none of the others, and then group after group.
void InterpolationPredictor::MakeHistory(std::span<int32_t> positions) const {
  const std::vector<int32_t>& fresh = stencils_.fresh();
  for (const int32_t place : fresh) {
    if (stencils_[place].leads()) MakeHistoryOfLeader(place, positions);
  }
  auto begin = fresh.begin();
  while (begin != fresh.end()) {
    const int32_t group_end = order_.group_begins[order_.GroupOf(*begin) + 1];
    const auto end = std::lower_bound(begin, fresh.end(), group_end);
    ParallelFor(end - begin, 512, [&](int64_t from, int64_t to) {
      for (int64_t at = from; at < to; ++at) {
        const int32_t place = begin[at];
        if (stencils_[place].leads()) continue;
        const Int32x4 blend = ToInts(BlendIn(place, positions));
        const Int32x4& detail = RestDetail(place);
        for (int axis = 0; axis < 3; ++axis) {
          positions[3 * static_cast<size_t>(place) + static_cast<size_t>(axis)] =
              Within(int64_t{blend[axis]} + detail[axis]);
        }
      }
    });
    begin = end;
  }
}

void InterpolationPredictor::MakeHistoryOfLeader(int32_t place,
                                                 std::span<int32_t> positions) const {
  const auto at = 3 * static_cast<size_t>(place);
  const int32_t neighbour = stencils_.KnownNeighbour(place);
  for (size_t axis = 0; axis < 3; ++axis) {
    int64_t moved = 0;
    if (neighbour >= 0) {
      const size_t known = 3 * static_cast<size_t>(neighbour) + axis;
      moved = int64_t{positions[known]} - rest_[known];
    }
    positions[at + axis] = Within(rest_[at + axis] + moved);
  }
}

// The places of a stencil are before another one, so that four numbers are there.
Double4 InterpolationPredictor::BlendIn(int32_t place, std::span<const int32_t> positions) const {
  return BlendOf(
      place, [&](int32_t of) { return LoadInts(positions.data() + 3 * static_cast<size_t>(of)); });
}

Int32x4 InterpolationPredictor::DetailIn(int32_t place, std::span<const int32_t> positions) const {
  if (stencils_[place].leads()) return Int32x4{};
  const int32_t* position = positions.data() + 3 * static_cast<size_t>(place);
  const Int32x4 whole = ToInts(BlendIn(place, positions));
  return Int32x4{position[0] - whole[0], position[1] - whole[1], position[2] - whole[2], 0};
}

void InterpolationPredictor::MakeRestDetails(const std::vector<int32_t>& places) {
  ParallelFor(static_cast<int64_t>(places.size()), 1024, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      at_rest_[static_cast<size_t>(places[at])] = DetailIn(places[at], rest_);
    }
  });
}

void InterpolationPredictor::MakeDetails(const std::vector<int32_t>& places,
                                         std::span<const int32_t> last,
                                         std::span<const int32_t> before) {
  if (last.empty()) return;
  ParallelFor(static_cast<int64_t>(places.size()), 1024, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const int32_t place = places[at];
      last_[static_cast<size_t>(place)] = DetailIn(place, last);
      before_[static_cast<size_t>(place)] = DetailIn(place, before);
    }
  });
}

// True if it is another.
bool InterpolationPredictor::SetGrid(double tolerance) {
  if (tolerance == tolerance_) return false;
  rest_ = QuantiseRest(stencils_.rest_positions(), origin_,
                       QuantisationStep(tolerance, domain_bound_) / kUnitsPerStep);
  tolerance_ = tolerance;
  return true;
}

void InterpolationPredictor::Prepare(bool key, double tolerance, std::span<const int32_t> broken,
                                     std::span<int32_t> last, std::span<int32_t> before,
                                     bool history_is_new) {
  const std::vector<int32_t>& touched = stencils_.SetBroken(order_, broken);
  const bool grid_is_new = SetGrid(tolerance);
  const std::vector<int32_t>& changed = history_is_new || grid_is_new ? places() : touched;
  MakeRestDetails(changed);
  if (!key) {
    RunBoth([&] { MakeHistory(last); }, [&] { MakeHistory(before); });
  }
  MakeDetails(changed, last, before);
}

void InterpolationPredictor::Return(double tolerance, std::span<const int32_t> broken,
                                    std::span<const int32_t> last,
                                    std::span<const int32_t> before) {
  stencils_.SetBroken(order_, broken);
  SetGrid(tolerance);
  MakeRestDetails(places());
  MakeDetails(places(), last, before);
}

void InterpolationPredictor::Accept(bool key) {
  before_.swap(last_);
  last_.swap(next_);
  if (key) before_ = last_;
}

void InterpolationPredictor::Hold() { before_ = last_; }

}  // namespace cleave
