#include "server/session/journal.h"

#include <fcntl.h>

#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr uint32_t kMaxRecordBytes = 1 << 20;
// Every run or pause adds some tens of bytes: this is millions of them.
constexpr int64_t kMaxJournalBytes = int64_t{1} << 30;

std::string ParentOf(const std::string& path) { return path.substr(0, path.find_last_of('/')); }

}  // namespace

JournalContents ParseJournal(absl::string_view bytes) {
  JournalContents contents;
  ByteReader reader(bytes);
  while (true) {
    const uint32_t length = reader.Get<uint32_t>();
    const uint32_t crc = reader.Get<uint32_t>();
    // A file system may leave zeros behind a crash: eight of them would be a valid empty record.
    if (!reader.ok() || length == 0 || length > kMaxRecordBytes) break;
    const absl::string_view record = reader.GetBytes(length);
    worker::v1::JournalRecord parsed;
    if (!reader.ok() || Crc32c(record) != crc ||
        !parsed.ParseFromArray(record.data(), static_cast<int>(record.size()))) {
      break;
    }
    contents.records.push_back(std::move(parsed));
    contents.whole_bytes += 8 + static_cast<int64_t>(length);
  }
  contents.torn_bytes = static_cast<int64_t>(bytes.size()) - contents.whole_bytes;
  return contents;
}

absl::StatusOr<JournalContents> ReadJournal(const std::string& path) {
  const absl::StatusOr<std::string> bytes = ReadFile(path, kMaxJournalBytes);
  if (absl::IsNotFound(bytes.status())) return JournalContents{};
  if (!bytes.ok()) return bytes.status();
  return ParseJournal(*bytes);
}

void JournalState::Apply(const worker::v1::JournalRecord& record) {
  switch (record.record_case()) {
    case worker::v1::JournalRecord::kRun:
      goal = record.run();
      last_goal_frame = record.run().goal().until_frame();
      failure.reset();
      if (!record.run().request_id().empty()) run_requests.insert(record.run().request_id());
      break;
    case worker::v1::JournalRecord::kPause:
    case worker::v1::JournalRecord::kRunEnded:
      goal.reset();
      break;
    case worker::v1::JournalRecord::kRunFailed:
      goal.reset();
      failure = record.run_failed();
      break;
    case worker::v1::JournalRecord::RECORD_NOT_SET:
      break;
  }
}

JournalState SummariseJournal(const std::vector<worker::v1::JournalRecord>& records) {
  JournalState state;
  for (const worker::v1::JournalRecord& record : records) state.Apply(record);
  return state;
}

absl::StatusOr<JournalWriter> JournalWriter::Open(const std::string& path,
                                                  const JournalContents& contents) {
  CLEAVE_ASSIGN_OR_RETURN(FileDescriptor file, OpenFile(path, O_RDWR | O_CREAT));
  CLEAVE_RETURN_IF_ERROR(SyncDirectory(ParentOf(path)));
  if (contents.torn_bytes > 0) {
    CLEAVE_RETURN_IF_ERROR(Truncate(file, contents.whole_bytes, path));
    CLEAVE_RETURN_IF_ERROR(SyncData(file, path));
  }
  return JournalWriter(path, std::move(file), contents.whole_bytes);
}

absl::Status JournalWriter::Append(const worker::v1::JournalRecord& record) {
  const std::string message = record.SerializeAsString();
  if (message.empty() || message.size() > kMaxRecordBytes) {
    return absl::InvalidArgumentError("a journal record must have 1 byte to 1 MiB");
  }
  std::string bytes;
  ByteWriter writer(bytes);
  writer.Put<uint32_t>(static_cast<uint32_t>(message.size()));
  writer.Put<uint32_t>(Crc32c(message));
  writer.PutBytes(message);
  absl::Status status = WriteAt(file_, size_, bytes, path_);
  if (status.ok()) status = SyncData(file_, path_);
  if (!status.ok()) {
    // What was half written must not come back as a record that nobody acknowledged.
    status.Update(Truncate(file_, size_, path_));
    return status;
  }
  size_ += static_cast<int64_t>(bytes.size());
  return absl::OkStatus();
}

}  // namespace cleave
