// What is apart in Stencils of a surface view.

#include <algorithm>
#include <cstddef>

#include "core/stream/stencils.h"

namespace cleave {

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

// A place that comes into view can be nearer to others than what they have. Those that may take it
// are searched from the start: its neighbours, those over two edges whose search went that far, and
// of its piece those that were found in space, also since it may be what leads there now.
void Stencils::TouchRoundFresh() {
  const auto touch_anew = [&](int32_t place) {
    Touch(place);
    reaches_[static_cast<size_t>(place)] = Reach::kOneEdge;
  };
  std::vector<uint8_t> has_fresh(static_cast<size_t>(pieces_.count()), 0);
  for (const int32_t place : fresh_) has_fresh[static_cast<size_t>(pieces_[place])] = 1;
  for (const int32_t place : visible_->places()) {
    if (reaches_[static_cast<size_t>(place)] == Reach::kSpace &&
        has_fresh[static_cast<size_t>(pieces_[place])] != 0) {
      touch_anew(place);
    }
  }
  for (const int32_t place : fresh_) {
    for (const int32_t between : graph_.Neighbours(place)) {
      if (between < 0) continue;
      for (const int32_t other : graph_.Neighbours(between)) {
        if (other > place && reaches_[static_cast<size_t>(other)] == Reach::kTwoEdges) {
          touch_anew(other);
        }
      }
      if (between > place) touch_anew(between);
    }
    touch_anew(place);
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
