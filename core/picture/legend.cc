#include "core/picture/legend.h"

#include <cmath>
#include <cstddef>

#include "core/picture/text.h"

namespace cleave {
namespace {

constexpr double kBar = 9;      // length of the map, in capitals
constexpr double kSpace = 0.7;  // between a swatch and its name
constexpr double kGap = 1.8;    // between two swatches

int Round(double value) { return static_cast<int>(std::lround(value)); }

}  // namespace

double LegendWidth(const Legend& legend, double height) {
  const TextStyle style{.height = height};
  if (!legend.map_title.empty()) {
    return TextWidth(legend.map_title, style) + TextWidth(legend.map_low, style) +
           TextWidth(legend.map_high, style) + (kBar + kGap + 2 * kSpace) * height;
  }
  double width = 0;
  for (const auto& [name, color] : legend.swatches) {
    if (width > 0) width += kGap * height;
    width += (1 + kSpace) * height + TextWidth(name, style);
  }
  return width;
}

void DrawLegend(const Legend& legend, double left, double baseline, double height, Image& image) {
  const TextStyle style{.height = height, .rim = kRim};
  const int top = Round(baseline - height);
  const int side = Round(height);
  if (!legend.map_title.empty()) {
    DrawText(legend.map_title, left, baseline, style, image);
    left += TextWidth(legend.map_title, style) + kGap * height;
    DrawText(legend.map_low, left, baseline, style, image);
    left += TextWidth(legend.map_low, style) + kSpace * height;
    const int width = Round(kBar * height);
    for (int x = 0; x < width; ++x) {
      FillRectangle(Round(left) + x, top, 1, side, SequentialColor((x + 0.5) / width), image);
    }
    left += (kBar + kSpace) * height;
    DrawText(legend.map_high, left, baseline, style, image);
    return;
  }
  for (const auto& [name, color] : legend.swatches) {
    FillRectangle(Round(left), top, side, side, color, image);
    left += (1 + kSpace) * height;
    DrawText(name, left, baseline, style, image);
    left += TextWidth(name, style) + kGap * height;
  }
}

}  // namespace cleave
