#include "core/picture/text.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/picture/legend.h"

namespace cleave {
namespace {

Image White(int width, int height) {
  Image image(width, height);
  std::fill(image.rgb.begin(), image.rgb.end(), uint8_t{255});
  return image;
}

int Dark(const Image& image, int x0, int x1) {
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = x0; x < x1; ++x) count += image.at(x, y)[0] < 128 ? 1 : 0;
  }
  return count;
}

TEST(Text, EveryPrintableLetterLeavesInkBetweenItsEnds) {
  const TextStyle style{.height = 24};
  for (char c = '!'; c <= '~'; ++c) {
    Image image = White(60, 50);
    const std::string text(1, c);
    DrawText(text, 10, 36, style, image);
    const int right = 10 + static_cast<int>(TextWidth(text, style)) + 3;
    EXPECT_GT(Dark(image, 7, right), 3) << c;
    EXPECT_EQ(Dark(image, 0, 7), 0) << c;
    EXPECT_EQ(Dark(image, right, 60), 0) << c;
  }
}

TEST(Text, LettersDiffer) {
  std::vector<std::vector<uint8_t>> seen;
  for (char c = '!'; c <= '~'; ++c) {
    Image image = White(60, 50);
    DrawText(std::string(1, c), 10, 36, {.height = 24}, image);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), image.rgb), 0) << c;
    seen.push_back(image.rgb);
  }
}

TEST(Text, OtherCodePointsAreOneBoxEachAndCutTextIsHarmless) {
  const TextStyle style{.height = 24};
  EXPECT_EQ(TextWidth("\xC2\xB5", style), TextWidth("\xE2\x82\xAC", style));
  Image image = White(20, 20);
  DrawText("wide text, far too long", -30, 12, style, image);
  DrawText("\xFF\xC2", 0, 60, style, image);
  EXPECT_GT(Dark(image, 0, 20), 0);
}

TEST(Legend, ShowsItsSwatchesAndItsMap) {
  Legend legend;
  EXPECT_EQ(LegendWidth(legend, 10), 0);
  legend.swatches = {{"crust", Color{1, 0, 0}}, {"crumb", Color{0, 0, 1}}};
  Image image = White(300, 40);
  DrawLegend(legend, 10, 30, 20, image);
  EXPECT_EQ(image.at(15, 20)[0], 255);
  EXPECT_EQ(image.at(15, 20)[2], 0);
  EXPECT_LT(LegendWidth(legend, 20), 290);
  bool blue = false;
  for (int x = 40; x < 300; ++x)
    blue = blue || (image.at(x, 20)[2] == 255 && image.at(x, 20)[0] == 0);
  EXPECT_TRUE(blue);

  legend.map_title = "strain";
  legend.map_low = "0";
  legend.map_high = "20 %";
  image = White(500, 40);
  DrawLegend(legend, 10, 30, 20, image);
  bool first = false;
  bool last = false;
  for (int x = 0; x < 500; ++x) {
    const uint8_t* c = image.at(x, 20);
    first = first || (c[0] < 75 && c[1] < 20 && c[2] > 70);
    last = last || (c[0] > 240 && c[1] > 220 && c[2] < 60);
  }
  EXPECT_TRUE(first);
  EXPECT_TRUE(last);
}

TEST(Text, IsShortenedToWhatFits) {
  const TextStyle style{.height = 12};
  const std::string text = "a bar of two materials that is pulled";
  EXPECT_EQ(Shortened(text, TextWidth(text, style), style), text);
  const std::string cut = Shortened(text, 150, style);
  EXPECT_LE(TextWidth(cut, style), 150);
  EXPECT_GT(TextWidth(cut, style), 120);
  EXPECT_EQ(cut.substr(cut.size() - 3), "...");
  EXPECT_EQ(text.substr(0, cut.size() - 3), cut.substr(0, cut.size() - 3));
  EXPECT_EQ(Shortened(text, 2, style), "");
}

TEST(Text, ARimTellsLettersFromWhatIsAsDarkBehindThem) {
  const auto lightest = [](double rim) {
    Image image(60, 20);
    DrawText("33", 10, 15, {.height = 10, .color = {0, 0, 0}, .rim = rim}, image);
    return *std::max_element(image.rgb.begin(), image.rgb.end());
  };
  EXPECT_EQ(lightest(0), 0);
  EXPECT_GT(lightest(0.2), 150);
}

}  // namespace
}  // namespace cleave
