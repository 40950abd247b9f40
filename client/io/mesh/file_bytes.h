#ifndef CLEAVE_CLIENT_IO_MESH_FILE_BYTES_H_
#define CLEAVE_CLIENT_IO_MESH_FILE_BYTES_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cleave {

// The largest mesh file that is read, and the most that a compressed one may grow to.
inline constexpr uint64_t kMaxMeshFileBytes = uint64_t{8} << 30;

// The content of a file; Zstandard frames are decompressed, whatever the file is called. NotFound,
// PermissionDenied, or InvalidArgument for a folder, a damaged or an oversized file; messages name
// the path.
absl::StatusOr<std::string> ReadFileBytes(const std::string& path);

// Decompresses Zstandard frames to at most `max_bytes`; memory grows with what comes out, not with
// what the frames announce. InvalidArgument for damaged or larger content.
absl::StatusOr<std::string> DecompressZstd(absl::string_view bytes, uint64_t max_bytes);

bool IsZstd(absl::string_view bytes);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_FILE_BYTES_H_
