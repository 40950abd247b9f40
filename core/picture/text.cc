#include "core/picture/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/picture/glyphs.h"

namespace cleave {
namespace {

constexpr double kCapital = 12;  // steps of the glyphs' grid in a capital
constexpr double kGap = 3.2;     // steps between letters
constexpr double kBlank = 4;

struct Segment {
  double x1, y1, x2, y2;  // pixels, y down
};

// The glyph at `place`, which moves past its code point.
const char* NextGlyph(absl::string_view text, size_t& place) {
  const auto c = static_cast<unsigned char>(text[place++]);
  if (c >= ' ' && c <= '~') return kGlyphs[c - static_cast<unsigned char>(' ')];
  while (place < text.size() && (static_cast<unsigned char>(text[place]) & 0xC0u) == 0x80u) ++place;
  return kUnknownGlyph;
}

// Appends the strokes of a glyph that starts at `left`; returns its width in steps.
double AddGlyph(const char* glyph, double left, double baseline, double step,
                std::vector<Segment>* segments) {
  if (*glyph == '\0') return kBlank;
  double width = 0;
  bool pen_down = false;
  double last_x = 0;
  double last_y = 0;
  while (*glyph != '\0') {
    if (*glyph == ' ') {
      pen_down = false;
      ++glyph;
      continue;
    }
    const double right = glyph[0] - '0';
    const double x = left + step * right;
    const double y = baseline - step * (glyph[1] - 'e');
    if (pen_down && segments != nullptr) segments->push_back({last_x, last_y, x, y});
    pen_down = true;
    last_x = x;
    last_y = y;
    width = std::max(width, right);
    glyph += 2;
  }
  return width;
}

double Distance(const Segment& s, double x, double y) {
  const double dx = s.x2 - s.x1;
  const double dy = s.y2 - s.y1;
  const double length = dx * dx + dy * dy;
  const double t =
      length > 0 ? std::clamp(((x - s.x1) * dx + (y - s.y1) * dy) / length, 0.0, 1.0) : 0.0;
  return std::hypot(x - s.x1 - t * dx, y - s.y1 - t * dy);
}

void Blend(const Color& color, double part, uint8_t* pixel) {
  for (size_t k = 0; k < 3; ++k) {
    pixel[k] = static_cast<uint8_t>(std::lround(pixel[k] + part * (255.0 * color[k] - pixel[k])));
  }
}

// The strokes of a text with a pen of this half width, pixels.
void DrawStrokes(absl::string_view text, double left, double baseline, double step, double half_pen,
                 const Color& color, double opacity, Image& image) {
  for (size_t place = 0; place < text.size();) {
    std::vector<Segment> segments;
    const double width = AddGlyph(NextGlyph(text, place), left, baseline, step, &segments);
    // Coverage is kept a glyph, so that strokes which cross do not darken twice.
    const double reach = half_pen + 1;
    const int x0 = std::max(0, static_cast<int>(std::floor(left - reach)));
    const int x1 = std::min(image.width, static_cast<int>(std::ceil(left + width * step + reach)));
    const int y0 = std::max(0, static_cast<int>(std::floor(baseline - 13 * step - reach)));
    const int y1 = std::min(image.height, static_cast<int>(std::ceil(baseline + 4 * step + reach)));
    for (int y = y0; y < y1 && !segments.empty(); ++y) {
      for (int x = x0; x < x1; ++x) {
        double nearest = 2 * reach;
        for (const Segment& segment : segments) {
          nearest = std::min(nearest, Distance(segment, x + 0.5, y + 0.5));
        }
        const double cover = std::clamp(half_pen + 0.5 - nearest, 0.0, 1.0);
        if (cover > 0) Blend(color, opacity * cover, image.at(x, y));
      }
    }
    left += (width + kGap) * step;
  }
}

}  // namespace

double TextWidth(absl::string_view text, const TextStyle& style) {
  double width = 0;
  for (size_t place = 0; place < text.size();) {
    if (place > 0) width += kGap;
    width += AddGlyph(NextGlyph(text, place), 0, 0, 1, nullptr);
  }
  return width * style.height / kCapital;
}

void DrawText(absl::string_view text, double left, double baseline, const TextStyle& style,
              Image& image) {
  constexpr Color kRimColor{0.95f, 0.95f, 0.96f};
  constexpr double kRimOpacity = 0.7;
  const double step = style.height / kCapital;
  const double half_pen = 0.5 * style.pen * style.height;
  if (style.rim > 0) {
    DrawStrokes(text, left, baseline, step, half_pen + style.rim * style.height, kRimColor,
                kRimOpacity, image);
  }
  DrawStrokes(text, left, baseline, step, half_pen, style.color, 1, image);
}

std::string Shortened(absl::string_view text, double width, const TextStyle& style) {
  if (TextWidth(text, style) <= width) return std::string(text);
  std::string best;
  for (size_t place = 0; place < text.size();) {
    NextGlyph(text, place);  // goes on to the next letter
    std::string part = absl::StrCat(text.substr(0, place), "...");
    if (TextWidth(part, style) > width) break;
    best = std::move(part);
  }
  return best;
}

void FillRectangle(int left, int top, int width, int height, const Color& color, Image& image) {
  const int x1 = std::min(image.width, left + width);
  const int y1 = std::min(image.height, top + height);
  for (int y = std::max(0, top); y < y1; ++y) {
    for (int x = std::max(0, left); x < x1; ++x) Blend(color, 1, image.at(x, y));
  }
}

}  // namespace cleave
