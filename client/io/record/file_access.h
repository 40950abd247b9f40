#ifndef CLEAVE_CLIENT_IO_RECORD_FILE_ACCESS_H_
#define CLEAVE_CLIENT_IO_RECORD_FILE_ACCESS_H_

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "core/stream/frame_log.h"

namespace cleave {

// A file for reading at any place. Its size is what it was when opened. Thread-safe.
class FileAccess final : public RandomAccess {
 public:
  // Errors: NotFound, PermissionDenied, InvalidArgument for what is no regular file.
  static absl::StatusOr<std::unique_ptr<FileAccess>> Open(const std::string& path);
  ~FileAccess() override;
  FileAccess(const FileAccess&) = delete;
  FileAccess& operator=(const FileAccess&) = delete;

  uint64_t size() const override { return size_; }
  absl::StatusOr<std::string> Read(uint64_t offset, uint64_t size) const override;

 private:
  FileAccess(std::string path, int descriptor, uint64_t size)
      : path_(std::move(path)), descriptor_(descriptor), size_(size) {}

  const std::string path_;
  const int descriptor_;
  const uint64_t size_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_RECORD_FILE_ACCESS_H_
