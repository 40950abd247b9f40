#include "client/io/record/recorder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/io/record/file_access.h"
#include "core/base/status.h"

namespace cleave {
namespace {

absl::Status SystemError(const std::string& path) {
  const std::string text = absl::StrCat(path, ": ", std::strerror(errno));
  if (errno == ENOSPC || errno == EDQUOT) return absl::ResourceExhaustedError(text);
  if (errno == ENOENT || errno == ENOTDIR) return absl::NotFoundError(text);
  return absl::PermissionDeniedError(text);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Recorder>> Recorder::Open(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) return SystemError(path);
  std::unique_ptr<Recorder> recorder(new Recorder(path, descriptor));
  CLEAVE_RETURN_IF_ERROR(recorder->Load());
  return recorder;
}

Recorder::~Recorder() { close(descriptor_); }

// Takes over what is whole in the file and cuts off the rest.
absl::Status Recorder::Load() {
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<FileAccess> file, FileAccess::Open(path_));
  uint64_t end = 0;
  if (file->size() > 0) {
    const auto reader = StreamFileReader::Open(*file);
    if (!reader.ok())
      return absl::InvalidArgumentError(absl::StrCat(
          path_, ": is not a recording that can be continued (", reader.status().message(), ")"));
    header_bytes_ = reader->header_bytes();
    index_.emplace(header_bytes_);
    for (size_t i = 0; i < reader->rows().size(); ++i) {
      CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, reader->ReadFrame(i));
      CLEAVE_RETURN_IF_ERROR(index_->Add(bytes));
    }
    end = reader->frames_end();
  }
  if (ftruncate(descriptor_, static_cast<off_t>(end)) != 0 ||
      lseek(descriptor_, static_cast<off_t>(end), SEEK_SET) < 0)
    return SystemError(path_);
  return absl::OkStatus();
}

std::optional<IndexRow> Recorder::last() const {
  if (!index_.has_value() || index_->rows().empty()) return std::nullopt;
  return index_->rows().back();
}

absl::Status Recorder::Write(absl::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return SystemError(path_);
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return absl::OkStatus();
}

absl::Status Recorder::Begin(absl::string_view header_bytes) {
  begun_ = true;
  if (header_bytes == header_bytes_) return absl::OkStatus();
  if (!header_bytes_.empty())
    return absl::FailedPreconditionError(
        absl::StrCat(path_, ": holds the frames of another simulation, or of another accuracy"));
  CLEAVE_RETURN_IF_ERROR(Write(header_bytes));
  header_bytes_ = std::string(header_bytes);
  index_.emplace(header_bytes_);
  return absl::OkStatus();
}

absl::Status Recorder::Append(absl::string_view frame_bytes) {
  if (!begun_) return absl::FailedPreconditionError("a recording begins with its header");
  CLEAVE_RETURN_IF_ERROR(Write(frame_bytes));
  return index_->Add(frame_bytes);
}

absl::Status Recorder::Finish() {
  if (!index_.has_value()) return absl::OkStatus();
  CLEAVE_RETURN_IF_ERROR(Write(index_->Footer()));
  if (fsync(descriptor_) != 0) return SystemError(path_);
  return absl::OkStatus();
}

}  // namespace cleave
