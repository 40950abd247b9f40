#ifndef CLEAVE_CLIENT_IO_BAKE_GROWING_FILE_H_
#define CLEAVE_CLIENT_IO_BAKE_GROWING_FILE_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cleave {

// How far a file is, and what it is made of.
struct FileMark {
  std::string start_key;  // of everything that is known before the first unit
  std::string key;        // of that and all `units` so far
  int64_t units = 0;
  int64_t bytes = 0;
};

// One line of JSON members: "made_from": "...", ... It stands in files beside the marked one.
std::string EncodeMark(const FileMark& mark);
// The mark in a text; nothing where there is none.
std::optional<FileMark> FindMark(absl::string_view text);

// A file too large for memory, written a unit at a time into PATH.part and renamed when it is
// whole. PATH.part.json marks how far it is on disk, so that a cut job goes on there. Errors of all
// calls carry the path and the system's reason. Not thread-safe.
class GrowingFile {
 public:
  explicit GrowingFile(std::string path);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  // The mark of the part that stands, if it is as long as the mark says.
  std::optional<FileMark> Part() const;

  absl::Status Begin();                     // anew
  absl::Status GoOn(const FileMark& mark);  // after the mark of Part()
  absl::Status Append(absl::string_view bytes);
  // Makes what was appended durable, then the mark of it; `mark.bytes` is filled in.
  absl::Status Save(FileMark mark);
  // Writes `head` over the beginning, makes all durable, renames it and drops the part's mark.
  absl::Status Finish(absl::string_view head);

  int64_t bytes() const { return bytes_; }

 private:
  std::string PartPath() const;
  absl::Status Open(int flags, int64_t bytes);

  const std::string path_;
  int file_ = -1;
  int64_t bytes_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_GROWING_FILE_H_
