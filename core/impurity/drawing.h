#ifndef CLEAVE_CORE_IMPURITY_DRAWING_H_
#define CLEAVE_CORE_IMPURITY_DRAWING_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/scene/impurities.h"

namespace cleave {

// A grey picture: rows from the top, black 0 to white 1.
struct GreyRaster {
  int width = 0;
  int height = 0;
  std::vector<float> values;

  float at(int x, int y) const {
    return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
};

// Nonzero for drawn pixels, rows from the top.
using PixelMask = std::vector<uint8_t>;

// Pixels darker than the threshold, or brighter where image.bright.
PixelMask DrawnPixels(const GreyRaster& raster, const ImageDrawing& image);

// Thins what is drawn to lines one pixel wide, but for some forks, that hang together as it did.
// Source: Zhang and Suen, "A fast parallel algorithm for thinning digital patterns", 1984.
PixelMask Thinned(const PixelMask& drawn, int width, int height);

// Turns a picture into curves along the middle of its lines: threshold, thinning, tracing without
// spurs shorter than the line is wide, and joining of pixels to segments that stray from them by at
// most image.tolerance. In units of the picture's width, from its middle, y up. With
// image.keep_width every point has the distance to the nearest pixel that is not drawn as half
// width. The same picture gives the same curves. Errors: InvalidArgument for a picture without
// pixels, or where nothing or everything is drawn.
absl::StatusOr<std::vector<DrawnCurve>> TraceDrawing(const GreyRaster& raster,
                                                     const ImageDrawing& image);

}  // namespace cleave

#endif  // CLEAVE_CORE_IMPURITY_DRAWING_H_
