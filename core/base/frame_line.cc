#include "core/base/frame_line.h"

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/strip.h"

namespace cleave {

int64_t FrameOfLine(absl::string_view line) {
  int64_t frame = -1;
  if (!absl::ConsumePrefix(&line, "{\"frame\":") || !absl::EndsWith(line, "}")) return -1;
  if (!absl::SimpleAtoi(line.substr(0, line.find_first_of(",}")), &frame)) return -1;
  return frame >= 0 ? frame : -1;
}

}  // namespace cleave
