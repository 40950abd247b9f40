#ifndef CLEAVE_SERVER_SESSION_CHECKPOINTS_H_
#define CLEAVE_SERVER_SESSION_CHECKPOINTS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cleave {

// The saved solver states of a session, a file a frame: magic, version, frame, size and crc32c of
// the state, then the state. Not thread-safe; one writer.
class Checkpoints {
 public:
  // `directory` must exist.
  explicit Checkpoints(std::string directory) : directory_(std::move(directory)) {}

  // Frames that have a file, newest first. Says nothing about what the files hold.
  absl::StatusOr<std::vector<int64_t>> List() const;

  // The state saved at `frame`. DataLoss when the file is torn or foreign.
  absl::StatusOr<std::string> Read(int64_t frame) const;

  // Saves durably, then removes all but the newest two that are whole.
  absl::Status Write(int64_t frame, absl::string_view state);

 private:
  std::string PathOf(int64_t frame) const;
  absl::Status RemoveOld() const;

  std::string directory_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_CHECKPOINTS_H_
