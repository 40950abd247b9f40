#ifndef CLEAVE_CORE_STREAM_REGION_H_
#define CLEAVE_CORE_STREAM_REGION_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/base/faults.h"
#include "core/base/vec3.h"
#include "core/stream/stream_header.h"

namespace cleave {

// What a viewer looks at: pieces with one of these nodes, and pieces of which a node is now within
// the box (m, least and largest corner). Frames say of each piece whether it is inside.
struct Region {
  std::vector<int32_t> nodes;
  std::optional<std::array<Vec3, 2>> box = std::nullopt;
  double outside_tolerance = 0;  // m, for the other pieces; at least twice that of the stream
};

// One fault, of field.max, for a box that holds nothing, along whichever axes.
void CheckBox(absl::string_view field, const std::array<Vec3, 2>& box, Faults& faults);

// Error: InvalidArgument with all that keeps this from being the region of a stream whose pieces
// inside have this tolerance (m).
absl::Status CheckRegion(const Region& region, const StreamHeader& header, double tolerance);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_REGION_H_
