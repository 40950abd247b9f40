#include "core/picture/impurity_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

// Pixels whose colour leans to magenta, and to yellow.
struct Leanings {
  int magenta = 0, yellow = 0;
};
Leanings Count(const Image& image) {
  Leanings count;
  // Below the legend.
  for (int y = image.height / 4; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* pixel = image.at(x, y);
      count.magenta += pixel[0] > pixel[1] + 60 && pixel[2] > pixel[1] + 40;
      count.yellow += pixel[0] > pixel[2] + 60 && pixel[1] > pixel[2] + 60;
    }
  }
  return count;
}

TEST(RenderImpurities, ShowsThemInMagentaOnYellow) {
  const TetMesh mesh = KuhnBox({8, 4, 2}, {2, 1, 0.5});
  ImpurityPictureOptions options;
  options.width = 160;
  options.samples = 1;
  std::vector<double> impurities(mesh.rest_positions.size(), 0);
  const auto pure = RenderImpurities(mesh, impurities, options);
  ASSERT_TRUE(pure.ok()) << pure.status();
  EXPECT_EQ(Count(*pure).magenta, 0);
  EXPECT_GT(Count(*pure).yellow, 1000);
  for (size_t node = 0; node < impurities.size(); ++node)
    impurities[node] = mesh.rest_positions[node][0] < 1 ? 1 : 0;
  const auto half = RenderImpurities(mesh, impurities, options);
  ASSERT_TRUE(half.ok()) << half.status();
  EXPECT_GT(Count(*half).magenta, 400);
  EXPECT_GT(Count(*half).yellow, 400);
  impurities.pop_back();
  EXPECT_FALSE(RenderImpurities(mesh, impurities, options).ok());
}

TEST(ImpurityShares, AreOfPotencyOrOfWhatEdgesCount) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::array<double, 6> potencies{0, -2, 4, 0, 0, 0};
  const std::array<std::array<int32_t, 2>, 4> edges{{{0, 1}, {2, 3}, {3, 4}, {4, 5}}};
  EXPECT_THAT(ImpurityShares(potencies, edges, std::array{0.25, 4.0, 1.0, 1.0}),
              testing::ElementsAre(0.75, 0.75, 1, 0.75, 0, 0));
  // A cut, and what never breaks.
  EXPECT_THAT(ImpurityShares(std::array<double, 6>{}, edges, std::array{0.0, 1.0, 1.0, infinity}),
              testing::ElementsAre(1, 1, 0, 0, 1, 1));
}

TEST(CheckImpurityPicture, NamesEveryBadOption) {
  ImpurityPictureOptions options;
  EXPECT_TRUE(CheckImpurityPicture(options, 960).ok());
  options.width = 961;
  options.camera.azimuth = std::numeric_limits<double>::quiet_NaN();
  options.camera.elevation = -89;
  const Faults faults = CheckImpurityPicture(options, 960);
  ASSERT_EQ(faults.error_count(), 3);
  EXPECT_EQ(faults.errors()[0].description, "961 is outside [16, 960] pixels");
  EXPECT_EQ(faults.errors()[1].field, "azimuth");
  EXPECT_EQ(faults.errors()[2].field, "elevation");
  EXPECT_FALSE(
      RenderImpurities(KuhnBox({1, 1, 1}, {1, 1, 1}), std::vector<double>(8, 0), options).ok());
}

}  // namespace
}  // namespace cleave
