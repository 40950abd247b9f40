#ifndef CLEAVE_SERVER_SESSION_OWNER_LOCK_H_
#define CLEAVE_SERVER_SESSION_OWNER_LOCK_H_

#include <chrono>
#include <string>

#include "absl/status/statusor.h"
#include "server/files/durable_file.h"

namespace cleave {

// The right to write something on disk, held by at most one process of a machine through flock(2)
// on a file that carries the owner's pid. The kernel gives it back when the process ends, however
// it ends; the file stays.
class OwnerLock {
 public:
  // Unavailable, naming the owner's pid, where another process still holds it after `patience`.
  static absl::StatusOr<OwnerLock> Acquire(
      const std::string& path, std::chrono::milliseconds patience = std::chrono::milliseconds(0));

 private:
  explicit OwnerLock(FileDescriptor file) : file_(std::move(file)) {}
  FileDescriptor file_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_OWNER_LOCK_H_
