#include "server/files/durable_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"

namespace cleave {
namespace {

absl::Status SystemError(absl::string_view action, absl::string_view path) {
  return absl::ErrnoToStatus(errno, absl::StrCat("cannot ", action, " ", path));
}

std::string ParentOf(const std::string& path) {
  const size_t slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  if (this != &other) {
    Close();
    fd_ = other.Release();
  }
  return *this;
}

int FileDescriptor::Release() { return std::exchange(fd_, -1); }

void FileDescriptor::Close() {
  if (fd_ >= 0) close(fd_);
  fd_ = -1;
}

absl::StatusOr<FileDescriptor> OpenFile(const std::string& path, int flags) {
  const int fd = open(path.c_str(), flags | O_CLOEXEC, 0600);
  if (fd < 0) return SystemError("open", path);
  return FileDescriptor(fd);
}

absl::Status WriteAt(const FileDescriptor& file, int64_t offset, absl::string_view bytes,
                     absl::string_view path) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file.get(), bytes.data(), bytes.size(), offset);
    if (written < 0) {
      if (errno == EINTR) continue;
      return SystemError("write", path);
    }
    bytes.remove_prefix(static_cast<size_t>(written));
    offset += written;
  }
  return absl::OkStatus();
}

absl::StatusOr<std::string> ReadAt(const FileDescriptor& file, int64_t offset, int64_t size,
                                   absl::string_view path) {
  // The size may come from a damaged record: nothing is allocated that the file cannot fill.
  CLEAVE_ASSIGN_OR_RETURN(const int64_t file_size, FileSize(file, path));
  if (offset < 0 || size < 0 || offset > file_size || size > file_size - offset) {
    return absl::DataLossError(
        absl::StrCat(path, " ends at byte ", file_size, ", before ", size, " bytes at ", offset));
  }
  std::string bytes(static_cast<size_t>(size), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = pread(file.get(), bytes.data() + done, bytes.size() - done,
                              offset + static_cast<int64_t>(done));
    if (got < 0) {
      if (errno == EINTR) continue;
      return SystemError("read", path);
    }
    if (got == 0) return absl::DataLossError(absl::StrCat(path, " became shorter"));
    done += static_cast<size_t>(got);
  }
  return bytes;
}

absl::StatusOr<int64_t> FileSize(const FileDescriptor& file, absl::string_view path) {
  struct stat info;
  if (fstat(file.get(), &info) != 0) return SystemError("stat", path);
  return static_cast<int64_t>(info.st_size);
}

absl::Status SyncData(const FileDescriptor& file, absl::string_view path) {
  if (fdatasync(file.get()) != 0) return SystemError("sync", path);
  return absl::OkStatus();
}

absl::Status Truncate(const FileDescriptor& file, int64_t size, absl::string_view path) {
  if (ftruncate(file.get(), size) != 0) return SystemError("truncate", path);
  return absl::OkStatus();
}

absl::StatusOr<std::string> ReadFile(const std::string& path, int64_t max_bytes) {
  CLEAVE_ASSIGN_OR_RETURN(const FileDescriptor file, OpenFile(path, O_RDONLY));
  CLEAVE_ASSIGN_OR_RETURN(const int64_t size, FileSize(file, path));
  if (size > max_bytes) {
    return absl::DataLossError(absl::StrCat(path, " has ", size, " bytes, more than ", max_bytes));
  }
  return ReadAt(file, 0, size, path);
}

absl::Status WriteFileDurably(const std::string& path, absl::string_view bytes) {
  const std::string aside = absl::StrCat(path, ".tmp");
  {
    CLEAVE_ASSIGN_OR_RETURN(const FileDescriptor file,
                            OpenFile(aside, O_WRONLY | O_CREAT | O_TRUNC));
    CLEAVE_RETURN_IF_ERROR(WriteAt(file, 0, bytes, aside));
    CLEAVE_RETURN_IF_ERROR(SyncData(file, aside));
  }
  return RenameDurably(aside, path);
}

absl::Status SyncDirectory(const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(const FileDescriptor directory, OpenFile(path, O_RDONLY | O_DIRECTORY));
  if (fsync(directory.get()) != 0) return SystemError("sync", path);
  return absl::OkStatus();
}

absl::Status MakeDirectory(const std::string& path) {
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) return SystemError("create", path);
  return SyncDirectory(ParentOf(path));
}

absl::Status RenameDurably(const std::string& from, const std::string& to) {
  if (rename(from.c_str(), to.c_str()) != 0) {
    return SystemError(absl::StrCat("rename ", from, " to"), to);
  }
  CLEAVE_RETURN_IF_ERROR(SyncDirectory(ParentOf(to)));
  const std::string from_parent = ParentOf(from);
  return from_parent == ParentOf(to) ? absl::OkStatus() : SyncDirectory(from_parent);
}

bool FileExists(const std::string& path) {
  struct stat info;
  return stat(path.c_str(), &info) == 0;
}

}  // namespace cleave
