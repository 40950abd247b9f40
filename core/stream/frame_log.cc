#include "core/stream/frame_log.h"

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/status.h"

namespace cleave {

absl::StatusOr<std::string> BufferAccess::Read(uint64_t offset, uint64_t size) const {
  if (offset > bytes_.size() || size > bytes_.size() - offset) {
    return absl::OutOfRangeError(
        absl::StrCat("bytes ", offset, " to ", offset, " + ", size, " of ", bytes_.size()));
  }
  return std::string(bytes_.substr(offset, size));
}

IndexRow MakeIndexRow(const FrameHeader& frame, uint32_t segment, uint64_t offset) {
  return {.frame = frame.frame,
          .epoch = frame.epoch,
          .kind = frame.kind,
          .segment = segment,
          .offset = offset,
          .length = frame.frame_bytes,
          .time = frame.time,
          .state_hash = frame.state_hash,
          .broken_edges = frame.broken_edges,
          .fragments = frame.fragments};
}

void AppendIndexRow(const IndexRow& row, std::string& out) {
  const size_t begin = out.size();
  ByteWriter writer(out);
  writer.Put(row.frame);
  writer.Put(row.epoch);
  writer.Put(static_cast<uint8_t>(row.kind));
  out.append(3, '\0');
  writer.Put(row.segment);
  writer.Put<uint32_t>(0);
  writer.Put(row.offset);
  writer.Put(row.length);
  writer.Put(row.time);
  writer.Put(row.state_hash);
  writer.Put(row.broken_edges);
  writer.Put(row.fragments);
  writer.Put<uint32_t>(0);
  writer.Put(Crc32c(absl::string_view(out).substr(begin)));
}

IndexPrefix ParseIndexRows(absl::string_view bytes) {
  IndexPrefix prefix;
  for (; bytes.size() >= kIndexRowBytes; bytes.remove_prefix(kIndexRowBytes)) {
    const absl::string_view covered = bytes.substr(0, kIndexRowBytes - sizeof(uint32_t));
    ByteReader reader(bytes.substr(0, kIndexRowBytes));
    IndexRow row;
    row.frame = reader.Get<int64_t>();
    row.epoch = reader.Get<uint32_t>();
    row.kind = static_cast<FrameKind>(reader.Get<uint8_t>());
    reader.GetBytes(3);
    row.segment = reader.Get<uint32_t>();
    reader.Get<uint32_t>();
    row.offset = reader.Get<uint64_t>();
    row.length = reader.Get<uint64_t>();
    row.time = reader.Get<double>();
    row.state_hash = reader.Get<uint64_t>();
    row.broken_edges = reader.Get<uint64_t>();
    row.fragments = reader.Get<int64_t>();
    reader.Get<uint32_t>();
    if (reader.Get<uint32_t>() != Crc32c(covered)) break;
    prefix.rows.push_back(row);
    prefix.valid_bytes += kIndexRowBytes;
  }
  return prefix;
}

std::optional<size_t> FindFrame(std::span<const IndexRow> rows, int64_t frame) {
  for (size_t at = rows.size(); at-- > 0;) {
    if (rows[at].frame == frame) return at;
  }
  return std::nullopt;
}

std::optional<size_t> FindFrameAtOrBefore(std::span<const IndexRow> rows, int64_t frame) {
  for (size_t at = rows.size(); at-- > 0;) {
    if (rows[at].frame <= frame) return at;
  }
  return std::nullopt;
}

std::optional<size_t> FindKeyframe(std::span<const IndexRow> rows, size_t position) {
  if (position >= rows.size()) return std::nullopt;
  for (size_t at = position + 1; at-- > 0;) {
    if (rows[at].epoch != rows[position].epoch) break;
    if (rows[at].kind == FrameKind::kKey) return at;
  }
  return std::nullopt;
}

absl::StatusOr<RecoveredFrames> RecoverFrames(const RandomAccess& file, uint64_t begin,
                                              uint32_t segment) {
  RecoveredFrames recovered;
  recovered.valid_bytes = begin;
  const uint64_t size = file.size();
  for (uint64_t at = begin; at <= size && size - at >= kFrameHeaderBytes;) {
    CLEAVE_ASSIGN_OR_RETURN(const std::string head, file.Read(at, kFrameHeaderBytes));
    const absl::StatusOr<FrameHeader> header = ParseFrameHeader(head);
    if (!header.ok() || header->frame_bytes > size - at) break;
    CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, file.Read(at, header->frame_bytes));
    // A section of a later version is whole too.
    if (const absl::Status status = SplitFrame(bytes).status();
        !status.ok() && !absl::IsUnimplemented(status)) {
      break;
    }
    recovered.rows.push_back(MakeIndexRow(*header, segment, at));
    at += header->frame_bytes;
    recovered.valid_bytes = at;
  }
  return recovered;
}

}  // namespace cleave
