#ifndef CLEAVE_SERVER_SESSION_FRAME_LOG_H_
#define CLEAVE_SERVER_SESSION_FRAME_LOG_H_

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/stream/frame_encoder.h"
#include "core/stream/frame_log.h"
#include "server/files/durable_file.h"

namespace cleave {

// frames/: segments NNNNNNNN.clv (a stream header, then frames; each segment after the first starts
// with a key frame) and the file `index`, a row a frame (core/stream/frame_log.h). A frame is
// committed once its row is durable: the bytes are synced before the row is written.

// Appends frames. One writer at a time (owner_lock.h). Not thread-safe.
class FrameLogWriter {
 public:
  // `directory` must exist. Cuts off what is not committed: torn rows, rows whose frame is not
  // whole, bytes behind the last frame. Errors: DataLoss and Unimplemented for a stream header;
  // where files cannot be read or written, the log stays as it is.
  static absl::StatusOr<FrameLogWriter> Open(std::string directory,
                                             int64_t segment_bytes = int64_t{64} << 20);

  // Newest committed frame, -1 for none.
  int64_t head() const { return rows_.empty() ? -1 : rows_.back().frame; }
  const std::vector<IndexRow>& rows() const { return rows_; }
  // The stream header that the log began with; empty while it has no frame.
  const std::string& header_bytes() const { return header_bytes_; }
  absl::StatusOr<std::string> ReadFrame(const IndexRow& row) const;

  // Commits a frame. `header_bytes` is that of its stream, always the same. After an error the log
  // ends where it ended before.
  absl::Status Append(absl::string_view header_bytes, const EncodedFrame& frame);

 private:
  FrameLogWriter(std::string directory, int64_t segment_bytes)
      : directory_(std::move(directory)), segment_bytes_(segment_bytes) {}

  absl::Status Recover();
  absl::StatusOr<bool> LastIsWhole() const;
  absl::Status StartSegment(uint32_t number, absl::string_view header_bytes);

  std::string directory_;
  int64_t segment_bytes_;
  std::string header_bytes_;
  std::vector<IndexRow> rows_;
  FileDescriptor index_;
  FileDescriptor segment_;
  uint32_t segment_number_ = 0;
  int64_t segment_end_ = 0;
};

// Whether an error of reading a log says that the log is at fault - torn, garbled, of another
// version - and not the machine, which may be better another time.
bool IsLogDamage(const absl::Status& error);

// Reads committed frames while another process appends. Thread-safe.
class FrameLogReader {
 public:
  explicit FrameLogReader(std::string directory) : directory_(std::move(directory)) {}

  // Takes note of rows that were appended, up to frame `head`: what the writer has announced as
  // committed. A log that does not exist yet is empty.
  absl::Status Refresh(int64_t head);

  // Newest frame known, -1 for none.
  int64_t head() const;
  // Rows known, oldest first; at most `limit`, from the first at or after `first_frame`.
  std::vector<IndexRow> Rows(int64_t first_frame, size_t limit) const;
  std::optional<IndexRow> Find(int64_t frame) const;
  // The key frame from which `frame` decodes.
  std::optional<IndexRow> Keyframe(int64_t frame) const;

  absl::StatusOr<std::string> ReadHeader() const;
  absl::StatusOr<std::string> ReadFrame(const IndexRow& row) const;

 private:
  std::string directory_;
  mutable std::mutex mutex_;
  std::vector<IndexRow> rows_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_FRAME_LOG_H_
