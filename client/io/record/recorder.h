#ifndef CLEAVE_CLIENT_IO_RECORD_RECORDER_H_
#define CLEAVE_CLIENT_IO_RECORD_RECORDER_H_

#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/stream/frame_log.h"
#include "core/stream/stream_file.h"

namespace cleave {

// Writes the frames of one stream into a .clv file, and goes on with a file that an earlier run, or
// a crash, left behind. Every frame is handed to the system when it is appended; Finish makes the
// file durable and adds its index. Not thread-safe.
class Recorder {
 public:
  // Opens `path` or creates it. A torn frame at its end is forgotten. Errors: InvalidArgument for a
  // file that is no recording (it is left alone), else the system's reason.
  static absl::StatusOr<std::unique_ptr<Recorder>> Open(const std::string& path);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // The last frame that the file holds; where to resume the stream. nullopt: none.
  std::optional<IndexRow> last() const;

  // Call once, before Append. FailedPrecondition when the file is of another stream.
  absl::Status Begin(absl::string_view header_bytes);
  absl::Status Append(absl::string_view frame_bytes);
  absl::Status Finish();

 private:
  Recorder(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  absl::Status Load();
  absl::Status Write(absl::string_view bytes);

  const std::string path_;
  const int descriptor_;
  std::string header_bytes_;  // empty while the file is
  std::optional<StreamFileIndex> index_;
  bool begun_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_RECORD_RECORDER_H_
