#include "core/stream/region.h"

#include <cstddef>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace cleave {

void CheckBox(absl::string_view field, const std::array<Vec3, 2>& box, Faults& faults) {
  const auto& [low, high] = box;
  std::vector<std::string> allowed;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (low[axis] <= high[axis]) continue;
    allowed.push_back(absl::StrCat("[", low[axis], ", inf) along ", std::string(1, "xyz"[axis])));
  }
  if (allowed.empty()) return;
  faults.Error(absl::StrCat(field, ".max"),
               absl::StrCat("(", absl::StrJoin(high, ", "), ") m is outside ",
                            absl::StrJoin(allowed, ", "), ", where ", field, ".min begins"));
}

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
  if (region.box.has_value()) CheckBox("box", *region.box, faults);
  return faults.ToStatus();
}

}  // namespace cleave
