#ifndef CLEAVE_SERVER_SESSION_REPORTS_H_
#define CLEAVE_SERVER_SESSION_REPORTS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "server/files/durable_file.h"

namespace cleave {

// reports.jsonl: a line of JSON a frame, each starting with {"frame":N. For people and plots, so
// lines are not synced one by one; no result depends on them. Not thread-safe; one writer.
class Reports {
 public:
  // Cuts what a crash left behind: a torn line, and lines of frames after `head`.
  static absl::StatusOr<Reports> Open(const std::string& path, int64_t head);

  // Frame of the last line, 0 for none (frame 0 has no report).
  int64_t last_frame() const { return last_frame_; }

  // `line` without its newline.
  absl::Status Append(int64_t frame, absl::string_view line);

 private:
  Reports(std::string path, FileDescriptor file, int64_t size, int64_t last_frame)
      : path_(std::move(path)), file_(std::move(file)), size_(size), last_frame_(last_frame) {}

  std::string path_;
  FileDescriptor file_;
  int64_t size_;
  int64_t last_frame_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_REPORTS_H_
