#ifndef CLEAVE_CORE_PICTURE_LEGEND_H_
#define CLEAVE_CORE_PICTURE_LEGEND_H_

#include <string>
#include <utility>
#include <vector>

#include "core/picture/image.h"
#include "core/picture/palette.h"

namespace cleave {

// What colours mean: named swatches, or the sequential map with the values at its ends.
struct Legend {
  std::vector<std::pair<std::string, Color>> swatches;
  std::string map_title;  // with it, the map is drawn instead
  std::string map_low;
  std::string map_high;
};

// Pixels that the legend takes with capitals of `height` pixels; 0 for one without content.
double LegendWidth(const Legend& legend, double height);

// Draws it on one line from `left` on, its text on `baseline` (pixels).
void DrawLegend(const Legend& legend, double left, double baseline, double height, Image& image);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_LEGEND_H_
