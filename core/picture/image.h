#ifndef CLEAVE_CORE_PICTURE_IMAGE_H_
#define CLEAVE_CORE_PICTURE_IMAGE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace cleave {

// Pixels in rows from the top, three bytes each: red, green, blue, sRGB-coded.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> rgb;

  Image() = default;
  Image(int image_width, int image_height)
      : width(image_width),
        height(image_height),
        rgb(static_cast<size_t>(image_width) * static_cast<size_t>(image_height) * 3) {}
  uint8_t* at(int x, int y) {
    return rgb.data() +
           3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
  }
  const uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

// Widest and tallest picture that is made: a poster in print, and far below what overflows.
inline constexpr int kMaxImageSide = 16384;

// The bytes of a PNG file (8-bit RGB). Errors: InvalidArgument for an image without pixels,
// Internal where libpng fails.
absl::StatusOr<std::string> EncodePng(const Image& image);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_IMAGE_H_
