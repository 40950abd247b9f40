#ifndef CLEAVE_CLIENT_CLI_EVENT_FILE_H_
#define CLEAVE_CLIENT_CLI_EVENT_FILE_H_

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cleave/v1/frame.pb.h"

namespace cleave {

// What broke in a frame, a line of JSON an event, each starting with {"frame":N: first the pieces
// there were before, where they are told, then the edges, then the pieces that split, each followed
// by what came off it. Empty for a frame without events.
std::string EventLines(const v1::FrameEvents& events);

// events.jsonl beside a recording: the lines of all its frames, in order. Not thread-safe.
class EventFile {
 public:
  // Opens `path` or creates it, and cuts what leads the recording, whose last frame is given: lines
  // of later frames and a torn one. Errors: the system's reason, with the path.
  static absl::StatusOr<std::unique_ptr<EventFile>> Open(const std::string& path,
                                                         int64_t last_frame);

  // To be called before the frame is recorded, so that a recorded frame has its events.
  absl::Status Append(const v1::FrameEvents& events);

 private:
  explicit EventFile(std::string path) : path_(std::move(path)), out_(path_, std::ios::app) {}

  const std::string path_;
  std::ofstream out_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_EVENT_FILE_H_
