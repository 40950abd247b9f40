#ifndef CLEAVE_CORE_STREAM_FRAME_LOG_H_
#define CLEAVE_CORE_STREAM_FRAME_LOG_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/stream/frame_header.h"

namespace cleave {

// Bytes that can be read at any place: a file, a buffer. Implementations say how they may be shared
// between threads.
class RandomAccess {
 public:
  virtual ~RandomAccess() = default;
  virtual uint64_t size() const = 0;
  // Reads exactly `size` bytes. Errors: OutOfRange beyond the end; whatever the medium gives.
  virtual absl::StatusOr<std::string> Read(uint64_t offset, uint64_t size) const = 0;
};

// A buffer that the caller keeps alive. Thread-safe.
class BufferAccess final : public RandomAccess {
 public:
  explicit BufferAccess(absl::string_view bytes) : bytes_(bytes) {}
  uint64_t size() const override { return bytes_.size(); }
  absl::StatusOr<std::string> Read(uint64_t offset, uint64_t size) const override;

 private:
  absl::string_view bytes_;
};

// One frame of a log; FORMAT.md, section "Index". A frame counts as written when its row is.
struct IndexRow {
  int64_t frame = 0;
  uint32_t epoch = 0;
  FrameKind kind = FrameKind::kKey;
  uint32_t segment = 0;  // number of the file that holds it; 0 in a single file
  uint64_t offset = 0;   // in that file, bytes
  uint64_t length = 0;   // bytes
  double time = 0;       // s
  uint64_t state_hash = 0;
  uint64_t broken_edges = 0;
  int64_t fragments = 0;
};

inline constexpr size_t kIndexRowBytes = 80;

// The row of a frame that lies at `offset` of `segment`.
IndexRow MakeIndexRow(const FrameHeader& frame, uint32_t segment, uint64_t offset);

void AppendIndexRow(const IndexRow& row, std::string& out);

// The rows that `bytes` begin with, up to the first that is torn or damaged; what follows
// valid_bytes is to be cut off.
struct IndexPrefix {
  std::vector<IndexRow> rows;
  uint64_t valid_bytes = 0;
};
IndexPrefix ParseIndexRows(absl::string_view bytes);

// Position in `rows` (in the order written) of the last row of this frame: the newest epoch's.
std::optional<size_t> FindFrame(std::span<const IndexRow> rows, int64_t frame);
// Position of the last row whose frame is not above `frame`, in the newest epoch that has one.
std::optional<size_t> FindFrameAtOrBefore(std::span<const IndexRow> rows, int64_t frame);
// Position of the key frame from which the row at `position` decodes: applying all rows from it to
// `position` gives that frame.
std::optional<size_t> FindKeyframe(std::span<const IndexRow> rows, size_t position);

// Reads the frames of a file from `begin` on, up to the first that is torn or damaged. All
// checksums are looked at, nothing is decoded. Errors: only those of `file`.
struct RecoveredFrames {
  std::vector<IndexRow> rows;
  uint64_t valid_bytes = 0;  // end of the last whole frame, from the start of the file
};
absl::StatusOr<RecoveredFrames> RecoverFrames(const RandomAccess& file, uint64_t begin,
                                              uint32_t segment);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_FRAME_LOG_H_
