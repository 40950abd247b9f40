#ifndef CLEAVE_SERVER_SESSION_EVENT_LOG_H_
#define CLEAVE_SERVER_SESSION_EVENT_LOG_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cleave/v1/frame.pb.h"
#include "server/files/durable_file.h"

namespace cleave {

// events: a record of frame 0 that has the pieces of the mesh (sessions of older builds have none),
// then what broke, a record a frame in which something did: frame, length, CRC-32C of the payload,
// payload (FrameEvents). The record of a frame is durable before the frame is committed,
// so whoever sees a committed frame finds all of its events.

// Appends records. One writer at a time (owner_lock.h). Not thread-safe.
class EventLogWriter {
 public:
  // Cuts what a crash left behind: a torn record, and those of frames after `head`. Errors:
  // DataLoss for a damaged record of a committed frame, whose events would be missed without a
  // word.
  static absl::StatusOr<EventLogWriter> Open(const std::string& path, int64_t head);

  // Frame of the last record, -1 for none.
  int64_t last_frame() const { return last_frame_; }

  // Precondition: events.frame() is after last_frame().
  absl::Status Append(const v1::FrameEvents& events);

 private:
  EventLogWriter(std::string path, FileDescriptor file)
      : path_(std::move(path)), file_(std::move(file)) {}

  std::string path_;
  FileDescriptor file_;
  int64_t size_ = 0;
  int64_t last_frame_ = -1;
};

// Reads the events of committed frames in order, while another process appends. Not thread-safe.
class EventLogReader {
 public:
  explicit EventLogReader(std::string path) : path_(std::move(path)) {}

  // The events of a committed frame; nothing where nothing broke. Frames are asked for in ascending
  // order. Errors: DataLoss for a damaged record before others.
  absl::StatusOr<std::optional<v1::FrameEvents>> Read(int64_t frame);

 private:
  std::string path_;
  FileDescriptor file_;
  int64_t offset_ = 0;  // of the next record
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_EVENT_LOG_H_
