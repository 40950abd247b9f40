#include "server/session/checkpoints.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/status.h"
#include "server/files/durable_file.h"

namespace cleave {
namespace {

constexpr uint32_t kMagic = 0x4B564C43;  // "CLVK"
constexpr uint32_t kVersion = 1;
constexpr int kKept = 2;
constexpr int64_t kMaxCheckpointBytes = int64_t{1} << 40;
constexpr absl::string_view kSuffix = ".checkpoint";
constexpr size_t kHeaderBytes = 4 + 4 + 8 + 4 + 8;

absl::Status CheckFile(absl::string_view bytes, int64_t frame, absl::string_view path) {
  ByteReader reader(bytes);
  const uint32_t magic = reader.Get<uint32_t>();
  const uint32_t version = reader.Get<uint32_t>();
  const int64_t named_frame = reader.Get<int64_t>();
  const uint32_t crc = reader.Get<uint32_t>();
  const absl::string_view state = reader.GetBytes(reader.Get<uint64_t>());
  CLEAVE_RETURN_IF_ERROR(reader.Finish(path));
  if (magic != kMagic || version != kVersion || named_frame != frame || crc != Crc32c(state)) {
    return absl::DataLossError(absl::StrCat(path, " is damaged"));
  }
  return absl::OkStatus();
}

}  // namespace

std::string Checkpoints::PathOf(int64_t frame) const {
  return absl::StrFormat("%s/%010d%s", directory_, frame, kSuffix);
}

absl::StatusOr<std::vector<int64_t>> Checkpoints::List() const {
  std::vector<int64_t> frames;
  std::error_code error;
  std::filesystem::directory_iterator entry(directory_, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    int64_t frame = 0;
    if (absl::EndsWith(name, kSuffix) &&
        absl::SimpleAtoi(name.substr(0, name.size() - kSuffix.size()), &frame) && frame >= 0) {
      frames.push_back(frame);
    }
  }
  if (error) return absl::ErrnoToStatus(error.value(), absl::StrCat("cannot list ", directory_));
  std::sort(frames.rbegin(), frames.rend());
  return frames;
}

absl::StatusOr<std::string> Checkpoints::Read(int64_t frame) const {
  const std::string path = PathOf(frame);
  absl::StatusOr<std::string> file = ReadFile(path, kMaxCheckpointBytes);
  if (!file.ok()) return file.status();
  CLEAVE_RETURN_IF_ERROR(CheckFile(*file, frame, path));
  file->erase(0, kHeaderBytes);
  return file;
}

absl::Status Checkpoints::Write(int64_t frame, absl::string_view state) {
  std::string bytes;
  bytes.reserve(state.size() + 64);
  ByteWriter writer(bytes);
  writer.Put<uint32_t>(kMagic);
  writer.Put<uint32_t>(kVersion);
  writer.Put<int64_t>(frame);
  writer.Put<uint32_t>(Crc32c(state));
  writer.Put<uint64_t>(state.size());
  writer.PutBytes(state);
  CLEAVE_RETURN_IF_ERROR(WriteFileDurably(PathOf(frame), bytes));
  return RemoveOld();
}

absl::Status Checkpoints::RemoveOld() const {
  CLEAVE_ASSIGN_OR_RETURN(const std::vector<int64_t> frames, List());
  int whole = 0;
  for (const int64_t frame : frames) {
    if (whole == kKept) {
      std::error_code error;
      std::filesystem::remove(PathOf(frame), error);
      if (error) {
        return absl::ErrnoToStatus(error.value(), absl::StrCat("cannot remove ", PathOf(frame)));
      }
    } else if (Read(frame).ok()) {
      ++whole;
    }
  }
  return absl::OkStatus();
}

}  // namespace cleave
