#include "core/stream/region.h"

#include <cstddef>

#include "absl/strings/str_cat.h"
#include "core/base/faults.h"

namespace cleave {

absl::Status CheckRegion(const Region& region, const StreamHeader& header, double tolerance) {
  Faults faults;
  if (!header.has_regions()) faults.Error("region", "the stream has none");
  if (!(region.outside_tolerance >= 2 * tolerance && region.outside_tolerance <= 1e9)) {
    faults.Error("outside_tolerance",
                 absl::StrCat(region.outside_tolerance, " is outside [", 2 * tolerance, ", 1e9]"));
  }
  for (size_t at = 0; at < region.nodes.size(); ++at) {
    const int64_t node = region.nodes[at];
    if (node >= 0 && node < static_cast<int64_t>(header.node_count)) continue;
    faults.Error(absl::StrCat("nodes[", at, "]"),
                 absl::StrCat(node, " is outside [0, ", header.node_count, ")"));
  }
  for (size_t axis = 0; region.box.has_value() && axis < 3; ++axis) {
    const auto& [low, high] = *region.box;
    if (low[axis] <= high[axis]) continue;
    faults.Error("box", absl::StrCat("from ", low[axis], " to ", high[axis], " m has no inside"));
  }
  return faults.ToStatus();
}

}  // namespace cleave
