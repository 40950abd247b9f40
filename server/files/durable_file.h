#ifndef CLEAVE_SERVER_FILES_DURABLE_FILE_H_
#define CLEAVE_SERVER_FILES_DURABLE_FILE_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

// Files that survive a crash of the process and of the machine. Every function reports the path and
// the system's reason; a full disk is ResourceExhausted.

namespace cleave {

// Owns a file descriptor.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(other.Release()) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor() { Close(); }

  int get() const { return fd_; }
  bool valid() const { return fd_ >= 0; }
  int Release();
  void Close();

 private:
  int fd_ = -1;
};

// Opens with open(2)'s flags (O_CLOEXEC is added); files are created for the owner only.
absl::StatusOr<FileDescriptor> OpenFile(const std::string& path, int flags);

// Writes all of `bytes` at `offset`.
absl::Status WriteAt(const FileDescriptor& file, int64_t offset, absl::string_view bytes,
                     absl::string_view path);
// Reads exactly `size` bytes at `offset`; DataLoss when the file ends before them: it was cut, or
// whoever says that they are there is damaged.
absl::StatusOr<std::string> ReadAt(const FileDescriptor& file, int64_t offset, int64_t size,
                                   absl::string_view path);
absl::StatusOr<int64_t> FileSize(const FileDescriptor& file, absl::string_view path);
// fdatasync(2).
absl::Status SyncData(const FileDescriptor& file, absl::string_view path);
absl::Status Truncate(const FileDescriptor& file, int64_t size, absl::string_view path);

// The whole file; DataLoss when it is larger than `max_bytes`, which no file is that this wrote:
// not ResourceExhausted, which tells of a full disk.
absl::StatusOr<std::string> ReadFile(const std::string& path, int64_t max_bytes);

// Replaces the file in one step: written aside, synced, renamed, directory synced. After a crash
// the file holds the old bytes or the new ones.
absl::Status WriteFileDurably(const std::string& path, absl::string_view bytes);

// Makes names created, renamed or removed in a directory durable.
absl::Status SyncDirectory(const std::string& path);
// Creates a directory for the owner only, and makes its name durable. One that exists is fine.
absl::Status MakeDirectory(const std::string& path);
// rename(2), with the directories of both names synced.
absl::Status RenameDurably(const std::string& from, const std::string& to);

bool FileExists(const std::string& path);

}  // namespace cleave

#endif  // CLEAVE_SERVER_FILES_DURABLE_FILE_H_
