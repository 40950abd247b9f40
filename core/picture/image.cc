#include "core/picture/image.h"

#include <png.h>

#include "absl/strings/str_cat.h"

namespace cleave {

absl::StatusOr<std::string> EncodePng(const Image& image) {
  if (image.width <= 0 || image.height <= 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("image of ", image.width, " x ", image.height, " pixels"));
  }
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  // The macro's bound holds for any content, so that one pass of compression is enough.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) ==
      0) {
    return absl::InternalError(absl::StrCat("writing PNG: ", header.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace cleave
