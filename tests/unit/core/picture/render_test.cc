#include "core/picture/render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace cleave {
namespace {

using ::testing::HasSubstr;

// Looks down -z at the square [-2, 2]^2, x to the right and y up.
Camera Overhead() {
  Camera camera;
  camera.position = {0, 0, 20};
  camera.right = {1, 0, 0};
  camera.up = {0, 1, 0};
  camera.forward = {0, 0, -1};
  camera.half_width = 0.1;
  camera.half_height = 0.1;
  camera.scene_radius = 3;
  camera.ground_normal = {0, 0, 1};
  camera.ground_height = -0.5;
  return camera;
}

// Two squares in the plane z = 0, left and right of the middle.
ShownSurface TwoSquares() {
  ShownSurface surface;
  for (const double left : {-1.5, 0.5}) {
    const auto first = static_cast<int32_t>(surface.points.size());
    surface.points.insert(
        surface.points.end(),
        {{left, -0.5, 0}, {left + 1, -0.5, 0}, {left + 1, 0.5, 0}, {left, 0.5, 0}});
    surface.triangles.push_back({first, first + 1, first + 2});
    surface.triangles.push_back({first, first + 2, first + 3});
  }
  surface.pieces = {0, 0, 1, 1};
  surface.inside = {0, 0, 0, 0};
  surface.regions = {0, 0, 0, 0};
  return surface;
}

Image Draw(const ShownSurface& surface, const RenderStyle& style) {
  auto renderer = Renderer::Create();
  EXPECT_TRUE(renderer.ok()) << renderer.status();
  auto image = renderer->Render(surface, Overhead(), style, 80, 80);
  EXPECT_TRUE(image.ok()) << image.status();
  return image.ok() ? *std::move(image) : Image();
}

int Difference(const uint8_t* a, const uint8_t* b) {
  int sum = 0;
  for (int k = 0; k < 3; ++k) sum += std::abs(a[k] - b[k]);
  return sum;
}

// Largest less smallest channel: 0 for grey.
int Saturation(const uint8_t* c) {
  return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]});
}

TEST(Render, KnownPixelsAreCoveredAndTheRestIsGround) {
  const Image image = Draw(TwoSquares(), RenderStyle{});
  for (const int x : {12, 20, 28, 52, 60, 68}) {
    for (const int y : {32, 40, 48}) EXPECT_GT(Saturation(image.at(x, y)), 60) << x << " " << y;
  }
  for (const int x : {4, 40, 76}) EXPECT_LT(Saturation(image.at(x, 40)), 20) << x;
  for (const int y : {4, 20, 60, 76}) EXPECT_LT(Saturation(image.at(20, y)), 20) << y;
}

TEST(Render, PiecesTakeDifferentColors) {
  RenderStyle style;
  style.color_by = ColorBy::kPiece;
  const Image image = Draw(TwoSquares(), style);
  EXPECT_GT(Difference(image.at(20, 40), image.at(60, 40)), 60);
  EXPECT_LT(Difference(image.at(16, 40), image.at(24, 40)), 12);
}

TEST(Render, CrackFacesAreLighterThanTheOutside) {
  ShownSurface surface = TwoSquares();
  surface.inside = {0, 0, 1, 1};
  const Image image = Draw(surface, RenderStyle{});
  EXPECT_GT(image.at(60, 40)[1], image.at(20, 40)[1] + 40);
}

TEST(Render, StrainIsInterpolatedBetweenPoints) {
  ShownSurface surface = TwoSquares();
  surface.strains = {0, 0.2f, 0.2f, 0, 0, 0, 0, 0};
  RenderStyle style;
  style.color_by = ColorBy::kStrain;
  style.strain_limit = 0.2;
  const Image image = Draw(surface, style);
  EXPECT_GT(image.at(28, 40)[0], image.at(20, 40)[0] + 30);
  EXPECT_GT(image.at(20, 40)[1], image.at(12, 40)[1] + 30);
}

TEST(Render, PropsAreGreyBesideTheBodyAndHideWhatIsBehindThem) {
  ShownSurface props = TwoSquares();
  for (Vec3& point : props.points) {
    point[0] += 0.6;
    point[2] += 0.3;
  }
  auto renderer = Renderer::Create();
  ASSERT_TRUE(renderer.ok()) << renderer.status();
  const auto image = renderer->Render(TwoSquares(), Overhead(), RenderStyle{}, 80, 80, props);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_GT(Saturation(image->at(14, 40)), 60);  // the body's left square, uncovered
  EXPECT_LT(Saturation(image->at(26, 40)), 30);  // behind a prop
  EXPECT_LT(image->at(26, 40)[0], 160);          // which is darker than the ground
}

TEST(Render, ABodyThrowsAShadowOnTheGround) {
  const Image bare = Draw(ShownSurface{}, RenderStyle{});
  const Image image = Draw(TwoSquares(), RenderStyle{});
  // The sun stands on the right, so that the gap is in the right square's shadow.
  EXPECT_LT(image.at(47, 40)[0], bare.at(47, 40)[0] - 20);
}

TEST(Render, BytesDoNotDependOnTheThreads) {
  const ShownSurface surface = TwoSquares();
  std::vector<uint8_t> one;
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    one = Draw(surface, RenderStyle{}).rgb;
  }
  EXPECT_EQ(one, Draw(surface, RenderStyle{}).rgb);
}

TEST(Render, ABodyFarFromTheOriginLooksTheSame) {
  ShownSurface surface = TwoSquares();
  const Image near_origin = Draw(surface, RenderStyle{});
  Camera camera = Overhead();
  for (Vec3& point : surface.points) point[1] += 0x1p26;
  camera.position[1] += 0x1p26;
  camera.scene_center[1] += 0x1p26;
  auto renderer = Renderer::Create();
  const auto far_away = renderer->Render(surface, camera, RenderStyle{}, 80, 80);
  ASSERT_TRUE(far_away.ok()) << far_away.status();
  EXPECT_EQ(far_away->rgb, near_origin.rgb);
}

TEST(Render, WhatIsPreparedOnceLooksTheSameFromEverySide) {
  const ShownSurface surface = TwoSquares();
  const ShownSurface no_props;
  auto renderer = Renderer::Create();
  ASSERT_TRUE(renderer.ok()) << renderer.status();
  const auto solids = renderer->Prepare(surface, no_props, Overhead().scene_center, RenderStyle{});
  ASSERT_TRUE(solids.ok()) << solids.status();
  for (const double angle : {0.0, 1.0, 2.5}) {
    const Camera camera = Turned(Overhead(), angle);
    const auto prepared = renderer->Draw(**solids, camera, RenderStyle{}.samples, 80, 80);
    const auto at_once = renderer->Render(surface, camera, RenderStyle{}, 80, 80);
    ASSERT_TRUE(prepared.ok() && at_once.ok());
    EXPECT_EQ(prepared->rgb, at_once->rgb) << angle;
  }
}

TEST(Render, BadInputIsRefusedByName) {
  auto renderer = Renderer::Create();
  ASSERT_TRUE(renderer.ok()) << renderer.status();
  RenderStyle style;
  style.samples = 0;
  style.color_by = ColorBy::kStrain;
  const std::string message(
      renderer->Render(TwoSquares(), Overhead(), style, 0, 80).status().message());
  EXPECT_THAT(message, HasSubstr("samples"));
  EXPECT_THAT(message, HasSubstr("width"));
  EXPECT_THAT(message, HasSubstr("strains"));
  ShownSurface surface = TwoSquares();
  surface.points[3][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(renderer->Render(surface, Overhead(), RenderStyle{}, 8, 8).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace cleave
