#ifndef CLEAVE_CLIENT_IO_IMPURITY_PICTURE_FILE_H_
#define CLEAVE_CLIENT_IO_IMPURITY_PICTURE_FILE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/impurity/drawing.h"
#include "core/scene/impurities.h"

namespace cleave {

// Most pixels of a picture that is read: enough for a scan of a large sheet.
inline constexpr int64_t kMaxPicturePixels = int64_t{64} << 20;

// Reads a PNG or JPEG file, told by its content, as grey; what is transparent is white. Errors name
// the path: NotFound, PermissionDenied, or InvalidArgument for other content, a damaged file or one
// with too many pixels.
absl::StatusOr<GreyRaster> ReadPictureFile(const std::string& path);

// The same for a file's bytes.
absl::StatusOr<GreyRaster> ParsePicture(absl::string_view bytes);

// One channel of a picture.
struct PictureBytes {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> values;  // rows from the top
};

// Reads one channel of a PNG or JPEG file as it stands there, whatever it lets through; of 16 bits
// the upper eight. Errors as above, and InvalidArgument for alpha that the picture has not.
absl::StatusOr<PictureBytes> ReadChannelFile(const std::string& path, TextureChannel channel);
absl::StatusOr<PictureBytes> ParseChannel(absl::string_view bytes, TextureChannel channel);

// The picture with at most `most` pixels a side, which are means over evenly divided rows and
// columns; as it is where it is no larger.
PictureBytes Reduced(const PictureBytes& picture, int most);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_IMPURITY_PICTURE_FILE_H_
