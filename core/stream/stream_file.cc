#include "core/stream/stream_file.h"

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr absl::string_view kIndexMagic = "CLVI";
constexpr absl::string_view kEndMagic = "CLVE";
constexpr size_t kIndexHeadBytes = 16;
constexpr size_t kTrailerBytes = 24;

}  // namespace

absl::Status StreamFileIndex::Add(absl::string_view frame_bytes) {
  CLEAVE_ASSIGN_OR_RETURN(const FrameHeader frame, ParseFrameHeader(frame_bytes));
  if (frame.frame_bytes != frame_bytes.size()) {
    return absl::DataLossError(
        absl::StrCat("frame has ", frame_bytes.size(), " bytes; it declares ", frame.frame_bytes));
  }
  rows_.push_back(MakeIndexRow(frame, 0, end_));
  end_ += frame_bytes.size();
  return absl::OkStatus();
}

std::string StreamFileIndex::Footer() const {
  std::string footer;
  ByteWriter writer(footer);
  writer.PutBytes(kIndexMagic);
  writer.Put(static_cast<uint32_t>(kIndexRowBytes));
  writer.Put(static_cast<uint64_t>(rows_.size()));
  for (const IndexRow& row : rows_) AppendIndexRow(row, footer);
  const size_t trailer = footer.size();
  writer.Put(end_);
  writer.Put(static_cast<uint64_t>(trailer));
  writer.Put(Crc32c(absl::string_view(footer).substr(trailer), Crc32c(footer.substr(0, trailer))));
  writer.PutBytes(kEndMagic);
  return footer;
}

absl::StatusOr<bool> StreamFileReader::ReadFooter() {
  const uint64_t size = file_->size();
  if (size < header_bytes_.size() + kIndexHeadBytes + kTrailerBytes) return false;
  const absl::StatusOr<std::string> trailer = file_->Read(size - kTrailerBytes, kTrailerBytes);
  if (!trailer.ok()) return trailer.status();
  ByteReader reader(*trailer);
  const auto index_offset = reader.Get<uint64_t>();
  const auto index_bytes = reader.Get<uint64_t>();
  const auto checksum = reader.Get<uint32_t>();
  if (reader.GetBytes(kEndMagic.size()) != kEndMagic || index_bytes < kIndexHeadBytes ||
      index_offset < header_bytes_.size() || index_offset > size - kTrailerBytes ||
      index_bytes != size - kTrailerBytes - index_offset) {
    return false;
  }
  CLEAVE_ASSIGN_OR_RETURN(const std::string index, file_->Read(index_offset, index_bytes));
  if (Crc32c(absl::string_view(*trailer).substr(0, 16), Crc32c(index)) != checksum) return false;
  ByteReader head(index);
  if (head.GetBytes(kIndexMagic.size()) != kIndexMagic || head.Get<uint32_t>() != kIndexRowBytes ||
      head.Get<uint64_t>() != (index_bytes - kIndexHeadBytes) / kIndexRowBytes) {
    return false;
  }
  IndexPrefix prefix = ParseIndexRows(absl::string_view(index).substr(kIndexHeadBytes));
  if (prefix.valid_bytes != index_bytes - kIndexHeadBytes) return false;
  for (const IndexRow& row : prefix.rows) {
    if (row.offset > index_offset || row.length > index_offset - row.offset) return false;
  }
  rows_ = std::move(prefix.rows);
  frames_end_ = index_offset;
  return true;
}

absl::StatusOr<StreamFileReader> StreamFileReader::Open(const RandomAccess& file) {
  StreamFileReader reader(file);
  if (file.size() < kStreamHeaderPrefixBytes) {
    return absl::DataLossError("stream header is truncated");
  }
  CLEAVE_ASSIGN_OR_RETURN(const std::string prefix, file.Read(0, kStreamHeaderPrefixBytes));
  CLEAVE_ASSIGN_OR_RETURN(const size_t header_size, StreamHeaderSize(prefix));
  if (file.size() < header_size) return absl::DataLossError("stream header is truncated");
  CLEAVE_ASSIGN_OR_RETURN(reader.header_bytes_, file.Read(0, header_size));
  CLEAVE_ASSIGN_OR_RETURN(reader.header_, ParseStreamHeader(reader.header_bytes_));
  CLEAVE_ASSIGN_OR_RETURN(reader.has_footer_, reader.ReadFooter());
  if (!reader.has_footer_) {
    CLEAVE_ASSIGN_OR_RETURN(RecoveredFrames recovered, RecoverFrames(file, header_size, 0));
    reader.rows_ = std::move(recovered.rows);
    reader.frames_end_ = recovered.valid_bytes;
  }
  return reader;
}

absl::StatusOr<std::string> StreamFileReader::ReadFrame(size_t position) const {
  if (position >= rows_.size()) {
    return absl::OutOfRangeError(
        absl::StrCat("frame at position ", position, " of ", rows_.size()));
  }
  const IndexRow& row = rows_[position];
  CLEAVE_ASSIGN_OR_RETURN(std::string bytes, file_->Read(row.offset, row.length));
  CLEAVE_ASSIGN_OR_RETURN(const FrameHeader header, ParseFrameHeader(bytes));
  if (header.frame != row.frame || header.epoch != row.epoch || header.kind != row.kind ||
      header.state_hash != row.state_hash) {
    return absl::DataLossError(
        absl::StrCat("the frame at byte ", row.offset, " is not frame ", row.frame));
  }
  return bytes;
}

absl::Status StreamFileReader::Seek(size_t position, FrameDecoder& decoder) const {
  if (position >= rows_.size()) {
    return absl::OutOfRangeError(
        absl::StrCat("frame at position ", position, " of ", rows_.size()));
  }
  const std::optional<size_t> key = FindKeyframe(rows_, position);
  if (!key.has_value()) {
    return absl::DataLossError(
        absl::StrCat("no key frame stands before the frame at position ", position));
  }
  size_t next = *key;
  for (size_t at = *key; at <= position; ++at) {
    if (rows_[at].frame == decoder.frame().frame && rows_[at].epoch == decoder.epoch() &&
        rows_[at].state_hash == decoder.state_hash()) {
      next = at + 1;
    }
  }
  for (; next <= position; ++next) {
    const absl::StatusOr<std::string> bytes = ReadFrame(next);
    const absl::Status status = bytes.ok() ? decoder.Apply(*bytes) : bytes.status();
    if (!status.ok())
      return absl::Status(status.code(),
                          absl::StrCat("frame ", rows_[next].frame, ": ", status.message()));
  }
  return absl::OkStatus();
}

}  // namespace cleave
