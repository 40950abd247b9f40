#ifndef CLEAVE_CORE_PICTURE_PALETTE_H_
#define CLEAVE_CORE_PICTURE_PALETTE_H_

#include <array>
#include <cstdint>

namespace cleave {

// Red, green and blue in [0, 1], sRGB-coded as files and screens take them.
using Color = std::array<float, 3>;

// A colour for a region's outer surface, and the lighter one of its inside; ten of them, then they
// repeat.
Color RegionColor(int32_t region);
Color InsideColor(int32_t region);

// A colour for a piece: the same for the same id everywhere, and far apart for neighbouring ids.
Color PieceColor(int32_t piece);

// A sequential map of [0, 1], even to the eye and readable without colour vision, from dark blue
// over green to yellow; values outside take the ends.
Color SequentialColor(double value);

// From yellow for the pure body at 0 to magenta for the most impure at 1; values outside take the
// ends.
Color ImpurityColor(double value);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_PALETTE_H_
