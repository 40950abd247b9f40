#include "server/session/event_log.h"

#include <fcntl.h>

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr int64_t kHeadBytes = 16;
constexpr int64_t kMaxRecordBytes = (int64_t{1} << 31) - 1;  // of Protobuf

struct Record {
  int64_t frame;
  int64_t bytes;  // of the payload
  uint32_t checksum;
};

// The record that begins at an offset, or nothing where the file ends in it.
absl::StatusOr<std::optional<Record>> ReadHead(const FileDescriptor& file, int64_t offset,
                                               int64_t file_size, const std::string& path) {
  if (file_size - offset < kHeadBytes) return std::nullopt;
  const absl::StatusOr<std::string> bytes = ReadAt(file, offset, kHeadBytes, path);
  if (!bytes.ok()) return bytes.status();
  ByteReader in(*bytes);
  Record record{};
  record.frame = in.Get<int64_t>();
  record.bytes = in.Get<uint32_t>();
  record.checksum = in.Get<uint32_t>();
  if (record.bytes > kMaxRecordBytes || file_size - offset - kHeadBytes < record.bytes)
    return std::nullopt;
  return record;
}

// The payload of a record, or nothing where it is damaged.
absl::StatusOr<std::optional<std::string>> ReadPayload(const FileDescriptor& file, int64_t offset,
                                                       const Record& record,
                                                       const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(std::string payload,
                          ReadAt(file, offset + kHeadBytes, record.bytes, path));
  if (Crc32c(payload) != record.checksum) return std::nullopt;
  return payload;
}

}  // namespace

absl::StatusOr<EventLogWriter> EventLogWriter::Open(const std::string& path, int64_t head) {
  CLEAVE_ASSIGN_OR_RETURN(FileDescriptor file, OpenFile(path, O_RDWR | O_CREAT));
  CLEAVE_RETURN_IF_ERROR(SyncDirectory(path.substr(0, path.find_last_of('/'))));
  EventLogWriter log(path, std::move(file));
  CLEAVE_ASSIGN_OR_RETURN(const int64_t file_size, FileSize(log.file_, path));
  while (true) {
    CLEAVE_ASSIGN_OR_RETURN(const std::optional<Record> record,
                            ReadHead(log.file_, log.size_, file_size, path));
    if (!record || record->frame <= log.last_frame_ || record->frame > head) break;
    CLEAVE_ASSIGN_OR_RETURN(const auto payload, ReadPayload(log.file_, log.size_, *record, path));
    if (!payload)
      return absl::DataLossError(absl::StrCat(path, ": the events of frame ", record->frame,
                                              " do not match their checksum"));
    log.last_frame_ = record->frame;
    log.size_ += kHeadBytes + record->bytes;
  }
  if (log.size_ < file_size) CLEAVE_RETURN_IF_ERROR(Truncate(log.file_, log.size_, path));
  return log;
}

absl::Status EventLogWriter::Append(const v1::FrameEvents& events) {
  const size_t payload_bytes = events.ByteSizeLong();
  if (payload_bytes > static_cast<size_t>(kMaxRecordBytes))
    return absl::ResourceExhaustedError(
        absl::StrCat("the events of frame ", events.frame(), " take ", payload_bytes, " bytes"));
  const std::string payload = events.SerializeAsString();
  std::string bytes;
  ByteWriter out(bytes);
  out.Put<int64_t>(events.frame());
  out.Put<uint32_t>(static_cast<uint32_t>(payload.size()));
  out.Put<uint32_t>(Crc32c(payload));
  out.PutBytes(payload);
  CLEAVE_RETURN_IF_ERROR(WriteAt(file_, size_, bytes, path_));
  CLEAVE_RETURN_IF_ERROR(SyncData(file_, path_));
  size_ += static_cast<int64_t>(bytes.size());
  last_frame_ = events.frame();
  return absl::OkStatus();
}

absl::StatusOr<std::optional<v1::FrameEvents>> EventLogReader::Read(int64_t frame) {
  if (!file_.valid()) {
    if (!FileExists(path_)) return std::nullopt;
    CLEAVE_ASSIGN_OR_RETURN(file_, OpenFile(path_, O_RDONLY));
  }
  CLEAVE_ASSIGN_OR_RETURN(const int64_t file_size, FileSize(file_, path_));
  while (true) {
    CLEAVE_ASSIGN_OR_RETURN(const std::optional<Record> record,
                            ReadHead(file_, offset_, file_size, path_));
    // What the writer is at belongs to a frame to come.
    if (!record || record->frame > frame) return std::nullopt;
    const int64_t begin = offset_;
    const int64_t end = begin + kHeadBytes + record->bytes;
    if (record->frame < frame) {
      offset_ = end;
      continue;
    }
    CLEAVE_ASSIGN_OR_RETURN(const auto payload, ReadPayload(file_, begin, *record, path_));
    v1::FrameEvents events;
    if (!payload || !events.ParseFromString(*payload))
      return absl::DataLossError(
          absl::StrCat(path_, ": the events of frame ", frame, " do not match their checksum"));
    offset_ = end;
    return events;
  }
}

}  // namespace cleave
