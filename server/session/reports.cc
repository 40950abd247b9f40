#include "server/session/reports.h"

#include <fcntl.h>

#include "absl/strings/str_cat.h"
#include "core/base/frame_line.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr int64_t kMaxReportBytes = int64_t{1} << 34;

}  // namespace

absl::StatusOr<Reports> Reports::Open(const std::string& path, int64_t head) {
  CLEAVE_ASSIGN_OR_RETURN(FileDescriptor file, OpenFile(path, O_RDWR | O_CREAT));
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(path, kMaxReportBytes));
  int64_t last_frame = 0;
  size_t size = 0;
  for (size_t end; (end = bytes.find('\n', size)) != std::string::npos; size = end + 1) {
    const int64_t frame = FrameOfLine(absl::string_view(bytes).substr(size, end - size));
    if (frame <= last_frame || frame > head) break;
    last_frame = frame;
  }
  if (size < bytes.size()) {
    CLEAVE_RETURN_IF_ERROR(Truncate(file, static_cast<int64_t>(size), path));
  }
  return Reports(path, std::move(file), static_cast<int64_t>(size), last_frame);
}

absl::Status Reports::Append(int64_t frame, absl::string_view line) {
  const std::string bytes = absl::StrCat(line, "\n");
  CLEAVE_RETURN_IF_ERROR(WriteAt(file_, size_, bytes, path_));
  size_ += static_cast<int64_t>(bytes.size());
  last_frame_ = frame;
  return absl::OkStatus();
}

}  // namespace cleave
