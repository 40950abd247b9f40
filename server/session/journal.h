#ifndef CLEAVE_SERVER_SESSION_JOURNAL_H_
#define CLEAVE_SERVER_SESSION_JOURNAL_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/worker/v1/records.pb.h"
#include "server/files/durable_file.h"

namespace cleave {

// The control history of a session: append-only records of a uint32 length (never 0), the crc32c of
// the record and the record, little-endian.

// What a journal's bytes hold, up to the last whole record. Total: any bytes are accepted.
struct JournalContents {
  std::vector<worker::v1::JournalRecord> records;
  int64_t whole_bytes = 0;  // end of the last whole record
  int64_t torn_bytes = 0;   // what follows it
};
JournalContents ParseJournal(absl::string_view bytes);

// A journal that does not exist yet is empty.
absl::StatusOr<JournalContents> ReadJournal(const std::string& path);

// What the history amounts to.
struct JournalState {
  std::optional<worker::v1::Run> goal;  // in force: neither ended, paused nor failed
  std::optional<worker::v1::RunFailed> failure;
  int64_t last_goal_frame = 0;  // until_frame of the newest run, 0 for none
  absl::flat_hash_set<std::string> run_requests;

  void Apply(const worker::v1::JournalRecord& record);
};
JournalState SummariseJournal(const std::vector<worker::v1::JournalRecord>& records);

// Appends to a journal. One writer at a time (owner_lock.h). Not thread-safe.
class JournalWriter {
 public:
  // Cuts a torn tail off, durably, and goes on behind the last whole record.
  static absl::StatusOr<JournalWriter> Open(const std::string& path,
                                            const JournalContents& contents);

  // Returns once the record is durable. After an error the journal holds what it held before.
  absl::Status Append(const worker::v1::JournalRecord& record);

 private:
  JournalWriter(std::string path, FileDescriptor file, int64_t size)
      : path_(std::move(path)), file_(std::move(file)), size_(size) {}

  std::string path_;
  FileDescriptor file_;
  int64_t size_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_JOURNAL_H_
