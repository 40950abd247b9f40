#ifndef CLEAVE_CLIENT_IO_SERIES_FRAME_SOURCE_H_
#define CLEAVE_CLIENT_IO_SERIES_FRAME_SOURCE_H_

#include <cstdint>
#include <functional>

#include "absl/status/statusor.h"
#include "core/stream/frame.h"

namespace cleave {

// Where exporters and pictures take frames from, one at a time, so that a long run never sits in
// memory.
struct FrameSource {
  int64_t count = 0;
  // Only nodes that surfaces are drawn from are known (Frame::visible).
  bool surface_only = false;
  // The frame at a position in [0, count), by ascending time. Positions are asked for in ascending
  // order within a pass; a caller may make several passes. Called from one thread at a time.
  std::function<absl::StatusOr<Frame>(int64_t position)> read;
  // Visits the frames that the source leaves out between the position before (or the start of the
  // run) and this one, in order, where it leaves any out: pieces have their names from all frames,
  // and velocities from the one before. Asked for, if at all, right before read(position). May be
  // empty.
  using Visit = std::function<absl::Status(const Frame& frame)>;
  std::function<absl::Status(int64_t position, const Visit& visit)> pass_by;
};

// Told after every item of a long job; answering false stops the job with Cancelled, and what was
// finished by then stays.
using Progress = std::function<bool(int64_t done, int64_t total)>;

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SERIES_FRAME_SOURCE_H_
