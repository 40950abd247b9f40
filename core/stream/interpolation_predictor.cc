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
  details_.resize(mesh.rest_positions.size());
  next_details_.resize(mesh.rest_positions.size());
}

Grid3 InterpolationPredictor::DetailIn(int32_t place, std::span<const int32_t> positions) const {
  Grid3 detail{};
  if (stencils_[place].leads()) return detail;
  const Grid3 blend = Blend(place, positions);
  for (size_t axis = 0; axis < 3; ++axis) {
    detail[axis] = positions[3 * static_cast<size_t>(place) + axis] - blend[axis];
  }
  return detail;
}

void InterpolationPredictor::MakeDetails(int32_t place, std::span<const int32_t> last,
                                         std::span<const int32_t> before) {
  Details& details = details_[static_cast<size_t>(place)];
  details.rest = DetailIn(place, rest_);
  if (last.empty()) return;
  details.last = DetailIn(place, last);
  details.before = DetailIn(place, before);
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
  const auto count = static_cast<int64_t>(all ? details_.size() : touched.size());
  ParallelFor(count, 1024, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      MakeDetails(all ? static_cast<int32_t>(at) : touched[static_cast<size_t>(at)], last, before);
    }
  });
}

void InterpolationPredictor::Accept(bool key) {
  ParallelFor(static_cast<int64_t>(details_.size()), 4096, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      Details& details = details_[at];
      details.before = key ? next_details_[at] : details.last;
      details.last = next_details_[at];
    }
  });
}

void InterpolationPredictor::Hold() {
  for (Details& details : details_) details.before = details.last;
}

}  // namespace cleave
