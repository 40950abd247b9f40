#include "core/stream/interpolation_predictor.h"

#include <cstddef>

namespace cleave {
namespace {

std::vector<Vec3> ByPlace(const NodeOrder& order, std::span<const Vec3> positions) {
  std::vector<Vec3> by_place(positions.size());
  for (size_t place = 0; place < by_place.size(); ++place) {
    by_place[place] = positions[static_cast<size_t>(order.nodes[place])];
  }
  return by_place;
}

}  // namespace

InterpolationPredictor::InterpolationPredictor(const StreamHeader& header, const StreamMesh& mesh)
    : order_(MakeNodeOrder(mesh.rest_positions)),
      stencils_(order_, ByPlace(order_, mesh.rest_positions), mesh.edges),
      origin_(header.origin),
      domain_bound_(header.domain_bound) {
  for (std::vector<Int32x4>* lanes : {&positions_, &next_, &last_, &before_, &at_rest_}) {
    lanes->resize(mesh.rest_positions.size());
  }
}

Int32x4 InterpolationPredictor::DetailIn(int32_t place, std::span<const int32_t> positions) const {
  if (stencils_[place].leads()) return Int32x4{};
  // The places of a stencil are before another one, so that four numbers are there.
  const Double4 blend = BlendOf(
      place, [&](int32_t of) { return LoadInts(positions.data() + 3 * static_cast<size_t>(of)); });
  const int32_t* position = positions.data() + 3 * static_cast<size_t>(place);
  const Int32x4 whole = ToInts(blend);
  return Int32x4{position[0] - whole[0], position[1] - whole[1], position[2] - whole[2], 0};
}

void InterpolationPredictor::MakeDetails(int32_t place, std::span<const int32_t> last,
                                         std::span<const int32_t> before) {
  at_rest_[static_cast<size_t>(place)] = DetailIn(place, rest_);
  if (last.empty()) return;
  last_[static_cast<size_t>(place)] = DetailIn(place, last);
  before_[static_cast<size_t>(place)] = DetailIn(place, before);
}

void InterpolationPredictor::Prepare(double tolerance, std::span<const int32_t> broken,
                                     std::span<const int32_t> last, std::span<const int32_t> before,
                                     bool history_is_new) {
  const std::vector<int32_t>& touched = stencils_.SetBroken(order_, broken);
  const bool grid_is_new = tolerance != tolerance_;
  if (grid_is_new) {
    rest_ = QuantiseRest(stencils_.rest_positions(), origin_,
                         QuantisationStep(tolerance, domain_bound_) / kUnitsPerStep);
    tolerance_ = tolerance;
  }
  const bool all = history_is_new || grid_is_new;
  const auto count = static_cast<int64_t>(all ? last_.size() : touched.size());
  ParallelFor(count, 1024, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      MakeDetails(all ? static_cast<int32_t>(at) : touched[static_cast<size_t>(at)], last, before);
    }
  });
}

void InterpolationPredictor::Accept(bool key) {
  before_.swap(last_);
  last_.swap(next_);
  if (key) before_ = last_;
}

void InterpolationPredictor::Hold() { before_ = last_; }

}  // namespace cleave
