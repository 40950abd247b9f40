#ifndef CLEAVE_CLIENT_IO_IMPURITY_PICTURE_FILE_H_
#define CLEAVE_CLIENT_IO_IMPURITY_PICTURE_FILE_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/impurity/drawing.h"

namespace cleave {

// Most pixels of a picture that is read: enough for a scan of a large sheet.
inline constexpr int64_t kMaxPicturePixels = int64_t{64} << 20;

// Reads a PNG or JPEG file, told by its content, as grey; what is transparent is white. Errors name
// the path: NotFound, PermissionDenied, or InvalidArgument for other content, a damaged file or one
// with too many pixels.
absl::StatusOr<GreyRaster> ReadPictureFile(const std::string& path);

// The same for a file's bytes.
absl::StatusOr<GreyRaster> ParsePicture(absl::string_view bytes);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_IMPURITY_PICTURE_FILE_H_
