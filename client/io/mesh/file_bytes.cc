#include "client/io/mesh/file_bytes.h"

#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/base/status.h"

namespace cleave {

bool IsZstd(absl::string_view bytes) { return absl::StartsWith(bytes, "\x28\xB5\x2F\xFD"); }

absl::StatusOr<std::string> DecompressZstd(absl::string_view bytes, uint64_t max_bytes) {
  const std::unique_ptr<ZSTD_DStream, size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                        ZSTD_freeDStream);
  if (stream == nullptr) return absl::ResourceExhaustedError("no memory for decompression");
  std::string content;
  std::string piece(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  size_t wanted = 0;
  bool full = false;  // the last piece was filled, so more may be waiting
  while (in.pos < in.size || full) {
    ZSTD_outBuffer out{piece.data(), piece.size(), 0};
    wanted = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(wanted) != 0) {
      return absl::InvalidArgumentError(absl::StrCat("the Zstandard frame is damaged near byte ",
                                                     in.pos, ": ", ZSTD_getErrorName(wanted)));
    }
    full = out.pos == out.size;
    if (content.size() + out.pos > max_bytes) {
      return absl::InvalidArgumentError(
          absl::StrCat("decompresses to more than ", max_bytes, " bytes"));
    }
    content.append(piece, 0, out.pos);
  }
  if (wanted != 0) return absl::InvalidArgumentError("the Zstandard frame is cut short");
  return content;
}

absl::StatusOr<std::string> ReadFileBytes(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const int error = errno;
    const std::string message =
        absl::StrCat(path, ": ", std::generic_category().message(error != 0 ? error : EIO));
    if (error == ENOENT) return absl::NotFoundError(message);
    if (error == EACCES) return absl::PermissionDeniedError(message);
    return absl::InvalidArgumentError(message);
  }
  // Read in pieces: a pipe or a special file has no size that could be asked for.
  std::string bytes;
  std::string piece(size_t{1} << 20, '\0');
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto count = static_cast<size_t>(file.gcount());
    if (bytes.size() + count > kMaxMeshFileBytes) {
      return absl::InvalidArgumentError(
          absl::StrCat(path, ": larger than ", kMaxMeshFileBytes, " bytes"));
    }
    bytes.append(piece, 0, count);
  }
  if (!file.eof()) return absl::InvalidArgumentError(absl::StrCat(path, ": cannot be read"));
  if (!IsZstd(bytes)) return bytes;
  absl::StatusOr<std::string> content = DecompressZstd(bytes, kMaxMeshFileBytes);
  if (!content.ok()) {
    return absl::Status(content.status().code(),
                        absl::StrCat(path, ": ", content.status().message()));
  }
  return content;
}

}  // namespace cleave
