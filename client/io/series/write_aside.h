#ifndef CLEAVE_CLIENT_IO_SERIES_WRITE_ASIDE_H_
#define CLEAVE_CLIENT_IO_SERIES_WRITE_ASIDE_H_

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cleave {

// Writes a whole file beside `path`, flushes it to disk and renames it into place: whoever sees
// `path` sees all of it. Errors carry the path and the system's reason.
absl::Status WriteAside(const std::string& path, absl::string_view bytes);

// The first bytes of a file, at most `limit`; empty where it cannot be read.
std::string ReadStart(const std::string& path, size_t limit);

// Makes a directory and its parents; a directory that stands already is fine.
absl::Status MakeDirectories(const std::string& path);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SERIES_WRITE_ASIDE_H_
