#include "client/io/preview/impurity_picture.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cleave
