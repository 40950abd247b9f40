#include "client/io/bake/growing_file.h"

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/io/series/write_aside.h"
#include "core/base/status.h"

namespace cleave {
namespace {

absl::Status Failure(const std::string& path, absl::string_view doing, int error) {
  return absl::ErrnoToStatus(error, absl::StrCat(doing, " ", path));
}

// What stands between `name": ` and the next comma, without quotation marks.
absl::string_view Member(absl::string_view text, absl::string_view name) {
  const std::string label = absl::StrCat("\"", name, "\": ");
  size_t begin = text.find(label);
  if (begin == absl::string_view::npos) return {};
  begin += label.size();
  const size_t end = text.find_first_of(",\n}", begin);
  absl::string_view value = text.substr(begin, end - begin);
  if (value.size() >= 2 && value.front() == '"' && value.back() == '"') {
    value = value.substr(1, value.size() - 2);
  }
  return value;
}

absl::Status WriteAll(int file, absl::string_view bytes, int64_t at, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file, bytes.data(), bytes.size(), at);
    if (written >= 0) {
      bytes.remove_prefix(static_cast<size_t>(written));
      at += written;
    } else if (errno != EINTR) {
      return Failure(path, "writing", errno);
    }
  }
  return absl::OkStatus();
}

}  // namespace

std::string EncodeMark(const FileMark& mark) {
  return absl::StrCat("\"started_from\": \"", mark.start_key, "\", \"made_from\": \"", mark.key,
                      "\", \"units_written\": ", mark.units, ", \"bytes\": ", mark.bytes);
}

std::optional<FileMark> FindMark(absl::string_view text) {
  FileMark mark;
  mark.start_key = std::string(Member(text, "started_from"));
  mark.key = std::string(Member(text, "made_from"));
  if (mark.start_key.empty() || mark.key.empty()) return std::nullopt;
  if (!absl::SimpleAtoi(Member(text, "units_written"), &mark.units)) return std::nullopt;
  if (!absl::SimpleAtoi(Member(text, "bytes"), &mark.bytes)) return std::nullopt;
  if (mark.units <= 0 || mark.bytes <= 0) return std::nullopt;
  return mark;
}

GrowingFile::GrowingFile(std::string path) : path_(std::move(path)) {}

GrowingFile::~GrowingFile() {
  if (file_ >= 0) ::close(file_);
}

std::string GrowingFile::PartPath() const { return absl::StrCat(path_, ".part"); }

std::optional<FileMark> GrowingFile::Part() const {
  std::optional<FileMark> mark = FindMark(ReadStart(absl::StrCat(PartPath(), ".json"), 4096));
  std::error_code error;
  const auto size = std::filesystem::file_size(PartPath(), error);
  if (error || !mark || size < static_cast<uintmax_t>(mark->bytes)) return std::nullopt;
  return mark;
}

absl::Status GrowingFile::Open(int flags, int64_t bytes) {
  file_ = ::open(PartPath().c_str(), flags | O_RDWR | O_CLOEXEC, 0666);
  if (file_ < 0) return Failure(PartPath(), "opening", errno);
  if (::ftruncate(file_, bytes) != 0) return Failure(PartPath(), "cutting", errno);
  bytes_ = bytes;
  return absl::OkStatus();
}

absl::Status GrowingFile::Begin() {
  std::error_code ignored;
  std::filesystem::remove(absl::StrCat(PartPath(), ".json"), ignored);  // of other data
  return Open(O_CREAT, 0);
}

absl::Status GrowingFile::GoOn(const FileMark& mark) { return Open(0, mark.bytes); }

absl::Status GrowingFile::Append(absl::string_view bytes) {
  CLEAVE_RETURN_IF_ERROR(WriteAll(file_, bytes, bytes_, PartPath()));
  bytes_ += static_cast<int64_t>(bytes.size());
  return absl::OkStatus();
}

absl::Status GrowingFile::Save(FileMark mark) {
  if (::fdatasync(file_) != 0) return Failure(PartPath(), "writing", errno);
  mark.bytes = bytes_;
  return WriteAside(absl::StrCat(PartPath(), ".json"), absl::StrCat("{", EncodeMark(mark), "}\n"));
}

absl::Status GrowingFile::Finish(absl::string_view head) {
  CLEAVE_RETURN_IF_ERROR(WriteAll(file_, head, 0, PartPath()));
  if (::fsync(file_) != 0) return Failure(PartPath(), "writing", errno);
  const int file = std::exchange(file_, -1);
  if (::close(file) != 0) return Failure(PartPath(), "closing", errno);
  if (std::rename(PartPath().c_str(), path_.c_str()) != 0) {
    return Failure(path_, "writing", errno);
  }
  std::error_code ignored;
  std::filesystem::remove(absl::StrCat(PartPath(), ".json"), ignored);
  return absl::OkStatus();
}

}  // namespace cleave
