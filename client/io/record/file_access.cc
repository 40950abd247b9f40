#include "client/io/record/file_access.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"

namespace cleave {

absl::StatusOr<std::unique_ptr<FileAccess>> FileAccess::Open(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    const std::string text = absl::StrCat(path, ": ", std::strerror(errno));
    if (errno == ENOENT || errno == ENOTDIR) return absl::NotFoundError(text);
    return absl::PermissionDeniedError(text);
  }
  struct stat facts {};
  if (fstat(descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) {
    close(descriptor);
    return absl::InvalidArgumentError(absl::StrCat(path, ": is not a regular file"));
  }
  return std::unique_ptr<FileAccess>(
      new FileAccess(path, descriptor, static_cast<uint64_t>(facts.st_size)));
}

FileAccess::~FileAccess() { close(descriptor_); }

absl::StatusOr<std::string> FileAccess::Read(uint64_t offset, uint64_t size) const {
  if (offset > size_ || size > size_ - offset)
    return absl::OutOfRangeError(absl::StrCat(path_, ": has ", size_, " bytes; ", size, " from ",
                                              offset, " on were asked for"));
  std::string bytes(size, '\0');
  for (uint64_t done = 0; done < size;) {
    const ssize_t got =
        pread(descriptor_, bytes.data() + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0)
      return absl::DataLossError(
          absl::StrCat(path_, ": ", got == 0 ? "became shorter" : std::strerror(errno)));
    done += static_cast<uint64_t>(got);
  }
  return bytes;
}

}  // namespace cleave
