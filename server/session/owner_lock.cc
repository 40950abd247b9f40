#include "server/session/owner_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "core/base/status.h"

namespace cleave {

absl::StatusOr<OwnerLock> OwnerLock::Acquire(const std::string& path,
                                             std::chrono::milliseconds patience) {
  CLEAVE_ASSIGN_OR_RETURN(FileDescriptor file, OpenFile(path, O_RDWR | O_CREAT));
  const auto end = std::chrono::steady_clock::now() + patience;
  while (flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      continue;
    }
    if (errno != EWOULDBLOCK) {
      return absl::ErrnoToStatus(errno, absl::StrCat("cannot lock ", path));
    }
    const absl::StatusOr<std::string> owner = ReadFile(path, 64);
    return absl::UnavailableError(absl::StrCat(
        path, " is held by process ",
        owner.ok() ? absl::StripSuffix(*owner, "\n") : absl::string_view("(unknown)")));
  }
  CLEAVE_RETURN_IF_ERROR(Truncate(file, 0, path));
  CLEAVE_RETURN_IF_ERROR(WriteAt(file, 0, absl::StrCat(getpid(), "\n"), path));
  return OwnerLock(std::move(file));
}

}  // namespace cleave
