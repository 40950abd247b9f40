#ifndef CLEAVE_CORE_BASE_FRAME_LINE_H_
#define CLEAVE_CORE_BASE_FRAME_LINE_H_

#include <cstdint>

#include "absl/strings/string_view.h"

namespace cleave {

// The frame of a line of reports or events, without its newline: JSON that starts with {"frame":N.
// -1 for a line that is torn or something else.
int64_t FrameOfLine(absl::string_view line);

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_FRAME_LINE_H_
