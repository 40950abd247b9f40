#include "server/session/frame_log.h"

#include <fcntl.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "core/base/status.h"
#include "core/stream/stream_header.h"

namespace cleave {
namespace {

// Rows of the ten million frames that a scene may have (limits.h).
constexpr int64_t kMaxIndexBytes = int64_t{10'000'001} * kIndexRowBytes;

std::string IndexPath(const std::string& directory) { return directory + "/index"; }

std::string SegmentPath(const std::string& directory, uint32_t number) {
  return absl::StrFormat("%s/%08d.clv", directory, number);
}

absl::StatusOr<std::string> ReadFrameBytes(const std::string& directory, const IndexRow& row) {
  const std::string path = SegmentPath(directory, row.segment);
  CLEAVE_ASSIGN_OR_RETURN(const FileDescriptor file, OpenFile(path, O_RDONLY));
  return ReadAt(file, static_cast<int64_t>(row.offset), static_cast<int64_t>(row.length), path);
}

absl::StatusOr<std::string> ReadHeaderBytes(const std::string& directory) {
  const std::string path = SegmentPath(directory, 0);
  CLEAVE_ASSIGN_OR_RETURN(const FileDescriptor file, OpenFile(path, O_RDONLY));
  CLEAVE_ASSIGN_OR_RETURN(const std::string prefix,
                          ReadAt(file, 0, kStreamHeaderPrefixBytes, path));
  CLEAVE_ASSIGN_OR_RETURN(const size_t size, StreamHeaderSize(prefix));
  return ReadAt(file, 0, static_cast<int64_t>(size), path);
}

// Rows that follow each other as a writer would have left them.
IndexPrefix ParseConsecutiveRows(absl::string_view bytes) {
  IndexPrefix prefix = ParseIndexRows(bytes);
  for (size_t i = 0; i < prefix.rows.size(); ++i) {
    const int64_t expected = i == 0 ? 0 : prefix.rows[i - 1].frame + 1;
    if (prefix.rows[i].frame == expected) continue;
    prefix.rows.resize(i);
    prefix.valid_bytes = i * kIndexRowBytes;
  }
  return prefix;
}

}  // namespace

absl::StatusOr<FrameLogWriter> FrameLogWriter::Open(std::string directory, int64_t segment_bytes) {
  FrameLogWriter log(std::move(directory), segment_bytes);
  CLEAVE_RETURN_IF_ERROR(log.Recover());
  return log;
}

absl::Status FrameLogWriter::Recover() {
  const std::string index_path = IndexPath(directory_);
  CLEAVE_ASSIGN_OR_RETURN(index_, OpenFile(index_path, O_RDWR | O_CREAT));
  CLEAVE_RETURN_IF_ERROR(SyncDirectory(directory_));
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(index_path, kMaxIndexBytes));
  rows_ = ParseConsecutiveRows(bytes).rows;
  while (!rows_.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(const bool whole, LastIsWhole());
    if (whole) break;
    rows_.pop_back();
  }
  CLEAVE_RETURN_IF_ERROR(
      Truncate(index_, static_cast<int64_t>(rows_.size() * kIndexRowBytes), index_path));
  CLEAVE_RETURN_IF_ERROR(SyncData(index_, index_path));
  // Segments are started anew over whatever an uncommitted frame left in them.
  if (rows_.empty()) return absl::OkStatus();
  CLEAVE_ASSIGN_OR_RETURN(header_bytes_, ReadHeaderBytes(directory_));
  const IndexRow& last = rows_.back();
  const std::string path = SegmentPath(directory_, last.segment);
  CLEAVE_ASSIGN_OR_RETURN(segment_, OpenFile(path, O_RDWR));
  segment_number_ = last.segment;
  segment_end_ = static_cast<int64_t>(last.offset + last.length);
  return Truncate(segment_, segment_end_, path);
}

absl::StatusOr<bool> FrameLogWriter::LastIsWhole() const {
  const absl::StatusOr<std::string> frame = ReadFrame(rows_.back());
  if (frame.ok()) return SplitFrame(*frame).ok();
  if (IsLogDamage(frame.status())) return false;
  return frame.status();
}

bool IsLogDamage(const absl::Status& error) {
  return absl::IsNotFound(error) || absl::IsDataLoss(error) || absl::IsUnimplemented(error);
}

absl::StatusOr<std::string> FrameLogWriter::ReadFrame(const IndexRow& row) const {
  return ReadFrameBytes(directory_, row);
}

absl::Status FrameLogWriter::StartSegment(uint32_t number, absl::string_view header_bytes) {
  const std::string path = SegmentPath(directory_, number);
  CLEAVE_ASSIGN_OR_RETURN(FileDescriptor file, OpenFile(path, O_RDWR | O_CREAT | O_TRUNC));
  CLEAVE_RETURN_IF_ERROR(SyncDirectory(directory_));
  CLEAVE_RETURN_IF_ERROR(WriteAt(file, 0, header_bytes, path));
  segment_ = std::move(file);
  segment_number_ = number;
  segment_end_ = static_cast<int64_t>(header_bytes.size());
  return absl::OkStatus();
}

absl::Status FrameLogWriter::Append(absl::string_view header_bytes, const EncodedFrame& frame) {
  if (frame.header.frame != head() + 1) {
    return absl::InternalError(
        absl::StrCat("frame ", frame.header.frame, " cannot follow frame ", head()));
  }
  if (!segment_.valid()) {
    CLEAVE_RETURN_IF_ERROR(StartSegment(0, header_bytes));
    header_bytes_ = std::string(header_bytes);
  } else if (header_bytes != header_bytes_) {
    return absl::FailedPreconditionError("the frames of a log have one stream header");
  } else if (segment_end_ >= segment_bytes_ && frame.header.kind == FrameKind::kKey) {
    CLEAVE_RETURN_IF_ERROR(StartSegment(segment_number_ + 1, header_bytes));
  }
  const std::string path = SegmentPath(directory_, segment_number_);
  CLEAVE_RETURN_IF_ERROR(WriteAt(segment_, segment_end_, frame.bytes, path));
  CLEAVE_RETURN_IF_ERROR(SyncData(segment_, path));
  const IndexRow row =
      MakeIndexRow(frame.header, segment_number_, static_cast<uint64_t>(segment_end_));
  std::string row_bytes;
  AppendIndexRow(row, row_bytes);
  const auto index_end = static_cast<int64_t>(rows_.size() * kIndexRowBytes);
  absl::Status status = WriteAt(index_, index_end, row_bytes, IndexPath(directory_));
  if (status.ok()) status = SyncData(index_, IndexPath(directory_));
  if (!status.ok()) {
    status.Update(Truncate(index_, index_end, IndexPath(directory_)));
    return status;
  }
  segment_end_ += static_cast<int64_t>(frame.bytes.size());
  rows_.push_back(row);
  return absl::OkStatus();
}

absl::Status FrameLogReader::Refresh(int64_t head) {
  const std::lock_guard lock(mutex_);
  const int64_t known = rows_.empty() ? -1 : rows_.back().frame;
  if (known >= head) return absl::OkStatus();
  const std::string path = IndexPath(directory_);
  const absl::StatusOr<FileDescriptor> file = OpenFile(path, O_RDONLY);
  if (absl::IsNotFound(file.status())) return absl::OkStatus();
  if (!file.ok()) return file.status();
  CLEAVE_ASSIGN_OR_RETURN(const int64_t size, FileSize(*file, path));
  const auto begin = static_cast<int64_t>(rows_.size() * kIndexRowBytes);
  if (size <= begin || size > kMaxIndexBytes) return absl::OkStatus();
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadAt(*file, begin, size - begin, path));
  for (const IndexRow& row : ParseIndexRows(bytes).rows) {
    const int64_t next = rows_.empty() ? 0 : rows_.back().frame + 1;
    if (row.frame != next || row.frame > head) break;
    rows_.push_back(row);
  }
  return absl::OkStatus();
}

int64_t FrameLogReader::head() const {
  const std::lock_guard lock(mutex_);
  return rows_.empty() ? -1 : rows_.back().frame;
}

std::vector<IndexRow> FrameLogReader::Rows(int64_t first_frame, size_t limit) const {
  const std::lock_guard lock(mutex_);
  std::vector<IndexRow> rows;
  // Frame n is row n: nothing is dropped from a log yet.
  for (size_t i = first_frame < 0 ? 0 : static_cast<size_t>(first_frame);
       i < rows_.size() && rows.size() < limit; ++i) {
    rows.push_back(rows_[i]);
  }
  return rows;
}

std::optional<IndexRow> FrameLogReader::Find(int64_t frame) const {
  const std::lock_guard lock(mutex_);
  const std::optional<size_t> position = FindFrame(rows_, frame);
  if (!position.has_value()) return std::nullopt;
  return rows_[*position];
}

std::optional<IndexRow> FrameLogReader::Keyframe(int64_t frame) const {
  const std::lock_guard lock(mutex_);
  const std::optional<size_t> position = FindFrame(rows_, frame);
  if (!position.has_value()) return std::nullopt;
  const std::optional<size_t> key = FindKeyframe(rows_, *position);
  if (!key.has_value()) return std::nullopt;
  return rows_[*key];
}

absl::StatusOr<std::string> FrameLogReader::ReadHeader() const {
  return ReadHeaderBytes(directory_);
}

absl::StatusOr<std::string> FrameLogReader::ReadFrame(const IndexRow& row) const {
  return ReadFrameBytes(directory_, row);
}

}  // namespace cleave
