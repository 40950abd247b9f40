#include "core/picture/shown_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/picture/palette.h"

namespace cleave {
namespace {

double Distance(const Color& a, const Color& b) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += std::pow(static_cast<double>(a[i] - b[i]), 2);
  return std::sqrt(sum);
}

TEST(Palette, NeighbouringPiecesHaveFarColors) {
  for (int32_t piece = 0; piece < 40; ++piece) {
    EXPECT_GT(Distance(PieceColor(piece), PieceColor(piece + 1)), 0.2) << piece;
    EXPECT_EQ(PieceColor(piece), PieceColor(piece));
  }
}

TEST(Palette, InsideIsFarFromOutsideForEveryRegion) {
  for (int32_t region = -3; region < 12; ++region) {
    EXPECT_GT(Distance(RegionColor(region), InsideColor(region)), 0.3) << region;
  }
}

TEST(Palette, SequentialMapGetsLighterAndHoldsItsEnds) {
  double last = -1;
  for (double value = 0; value <= 1.0001; value += 0.0625) {
    const Color color = SequentialColor(value);
    const double luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    EXPECT_GT(luminance, last) << value;
    last = luminance;
  }
  EXPECT_EQ(SequentialColor(-4), SequentialColor(0));
  EXPECT_EQ(SequentialColor(7), SequentialColor(1));
}

TEST(ShownSurface, AnEmptySurfaceIsSound) { EXPECT_TRUE(CheckShownSurface(ShownSurface{}).ok()); }

}  // namespace
}  // namespace cleave
