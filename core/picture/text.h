#ifndef CLEAVE_CORE_PICTURE_TEXT_H_
#define CLEAVE_CORE_PICTURE_TEXT_H_

#include <string>

#include "absl/strings/string_view.h"
#include "core/picture/image.h"
#include "core/picture/palette.h"

namespace cleave {

// How text looks: the height of capitals in pixels, and the width of the pen as part of it.
struct TextStyle {
  double height = 10;
  double pen = 0.14;
  Color color{0.16f, 0.17f, 0.19f};
  double rim = 0;  // as part of the height: how far a light rim goes, over whatever is behind
};

// A rim for text that pieces may fly behind.
inline constexpr double kRim = 0.18;

// Pixels from the first stroke to the last.
double TextWidth(absl::string_view text, const TextStyle& style);

// As many of the text's first letters as fit into `width` pixels with "..." after them, or all of
// it where that fits.
std::string Shortened(absl::string_view text, double width, const TextStyle& style);

// Draws text with smooth edges, from `left` on, its baseline at `baseline` (pixels from the left
// and the top). Printable ASCII has letters; every other code point is an empty box. What falls
// outside of the image is cut.
void DrawText(absl::string_view text, double left, double baseline, const TextStyle& style,
              Image& image);

// Fills a rectangle in pixels, cut to the image.
void FillRectangle(int left, int top, int width, int height, const Color& color, Image& image);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_TEXT_H_
