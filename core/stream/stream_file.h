#ifndef CLEAVE_CORE_STREAM_STREAM_FILE_H_
#define CLEAVE_CORE_STREAM_STREAM_FILE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_log.h"
#include "core/stream/stream_header.h"

namespace cleave {

// The single-file form of a stream (.clv): stream header, frames, then an index and a trailer; what
// lacks the last two, as after a crash, reads the same. A session's segments are such files too.

// Says what to append to a .clv, in order: header(), then each frame's bytes, then the footer.
class StreamFileIndex {
 public:
  // `header_bytes` as FrameEncoder::header_bytes().
  explicit StreamFileIndex(absl::string_view header_bytes) : end_(header_bytes.size()) {}

  // Takes note of a frame that is appended. Error: DataLoss when these bytes are not one frame.
  absl::Status Add(absl::string_view frame_bytes);
  // Index and trailer, the last bytes of the file.
  std::string Footer() const;
  const std::vector<IndexRow>& rows() const { return rows_; }

 private:
  uint64_t end_;
  std::vector<IndexRow> rows_;
};

// Reads a .clv. Not thread-safe.
class StreamFileReader {
 public:
  // `file` must live as long as the reader. A file without a valid footer is scanned; frames after
  // a torn one are not found. Errors: as ParseStreamHeader, and those of `file`.
  static absl::StatusOr<StreamFileReader> Open(const RandomAccess& file);

  const StreamHeader& header() const { return header_; }
  const std::string& header_bytes() const { return header_bytes_; }
  const std::vector<IndexRow>& rows() const { return rows_; }
  // False when the index had to be rebuilt.
  bool has_footer() const { return has_footer_; }
  // End of the last whole frame: where a writer goes on.
  uint64_t frames_end() const { return frames_end_; }

  // The bytes of the frame at `position` of rows(). Errors: OutOfRange; DataLoss when they are not
  // the frame that the index names.
  absl::StatusOr<std::string> ReadFrame(size_t position) const;

  // Brings `decoder` to the frame at `position`, going on from where it is when that is on the way,
  // else from the newest key frame. Errors: those of ReadFrame and FrameDecoder::Apply; the decoder
  // then stands at the last good frame on the way.
  absl::Status Seek(size_t position, FrameDecoder& decoder) const;

 private:
  explicit StreamFileReader(const RandomAccess& file) : file_(&file) {}
  // True when the file ends in a whole footer, whose rows are then taken.
  absl::StatusOr<bool> ReadFooter();

  const RandomAccess* file_;
  StreamHeader header_;
  std::string header_bytes_;
  std::vector<IndexRow> rows_;
  bool has_footer_ = false;
  uint64_t frames_end_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_STREAM_FILE_H_
