#include "core/impurity/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "absl/strings/string_view.h"
#include "core/impurity/bake.h"
#include "core/mesh/incidence.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

// A picture that is black where `ink` holds of places in [-0.5, 0.5] across, y up.
GreyRaster Picture(int width, int height, const std::function<bool(double, double)>& ink) {
  GreyRaster raster{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      raster.values.push_back(
          ink((x + 0.5 - width / 2.0) / width, (height / 2.0 - y - 0.5) / width) ? 0.1f : 0.9f);
    }
  }
  return raster;
}

double ToSegment(double x, double y, double ax, double ay, double bx, double by) {
  const double dx = bx - ax, dy = by - ay;
  const double s = std::clamp(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(x - ax - s * dx, y - ay - s * dy);
}

// Two strokes of half width 0.06 that cross, and a ring.
double ToCross(double x, double y) {
  return std::min(ToSegment(x, y, -0.4, -0.3, 0.1, 0.35), ToSegment(x, y, -0.4, 0.3, 0.05, -0.3));
}
double ToRing(double x, double y) { return std::abs(std::hypot(x - 0.25, y - 0.05) - 0.15); }
bool Drawn(double x, double y) { return ToCross(x, y) < 0.05 || ToRing(x, y) < 0.05; }

TEST(Thinned, LeavesLinesOnePixelWideThatHangTogether) {
  const GreyRaster raster = Picture(120, 100, Drawn);
  const PixelMask drawn = DrawnPixels(raster, {});
  const PixelMask thin = Thinned(drawn, 120, 100);
  int pixels = 0, blocks = 0;
  for (size_t y = 0; y + 1 < 100; ++y) {
    for (size_t x = 0; x + 1 < 120; ++x) {
      const size_t k = 120 * y + x;
      EXPECT_LE(thin[k], drawn[k]);
      pixels += thin[k];
      blocks += thin[k] && thin[k + 1] && thin[k + 120] && thin[k + 121];
    }
  }
  EXPECT_LE(blocks, 3);  // at forks
  EXPECT_GT(pixels, 150);
  EXPECT_LT(pixels, 400);
  // As many pieces as before: two, by flooding.
  int pieces = 0;
  PixelMask seen = thin;
  for (size_t seed = 0; seed < seen.size(); ++seed) {
    if (seen[seed] == 0) continue;
    ++pieces;
    std::vector<size_t> queue = {seed};
    seen[seed] = 0;
    while (!queue.empty()) {
      const size_t at = queue.back();
      queue.pop_back();
      for (const int step : {-121, -120, -119, -1, 1, 119, 120, 121}) {
        const auto next = static_cast<size_t>(static_cast<int>(at) + step);
        if (next >= seen.size() || seen[next] == 0) continue;
        seen[next] = 0;
        queue.push_back(next);
      }
    }
  }
  EXPECT_EQ(pieces, 2);
}

TEST(TraceDrawing, FollowsTheMiddleOfLinesWithTheirWidth) {
  ImageDrawing image;
  image.keep_width = true;
  const auto curves = *TraceDrawing(Picture(200, 160, Drawn), image);
  EXPECT_LT(curves.size(), 10u);
  double length = 0;
  for (const DrawnCurve& curve : curves) {
    ASSERT_EQ(curve.half_widths.size(), curve.points.size());
    for (size_t k = 0; k < curve.points.size(); ++k) {
      const auto [x, y] = curve.points[k];
      const double off = std::min(ToCross(x, y), ToRing(x, y));
      // Where lines meet, the middle of the ink is not that of one of them.
      EXPECT_LT(off, 0.05);
      EXPECT_LT(curve.half_widths[k], 0.105);
      if (k > 0) {
        length += std::hypot(x - curve.points[k - 1][0], y - curve.points[k - 1][1]);
      }
    }
  }
  // Strokes of 0.82 and 0.75, which thinning shortens by their half width, and a ring of 0.94.
  EXPECT_GT(length, 2.1);
  EXPECT_LT(length, 2.8);
}

TEST(TraceDrawing, StraysNoFartherThanItsToleranceAndSavesPoints) {
  const GreyRaster raster = Picture(200, 160, [](double x, double y) {
    return std::abs(y - 0.2 * std::sin(9 * x)) < 0.004 && std::abs(x) < 0.45;
  });
  size_t last = 100000;
  for (const double tolerance : {0.0, 0.5, 3.0}) {
    ImageDrawing image;
    image.tolerance = tolerance;
    const auto curves = *TraceDrawing(raster, image);
    size_t points = 0;
    for (const DrawnCurve& curve : curves) points += curve.points.size();
    EXPECT_LT(points, last) << tolerance;
    last = points;
  }
}

TEST(TraceDrawing, KeepsDotsRingsAndWhatIsBright) {
  ImageDrawing image;
  const auto dot = *TraceDrawing(
      Picture(11, 11, [](double x, double y) { return std::hypot(x, y) < 0.02; }), image);
  ASSERT_EQ(dot.size(), 1u);
  EXPECT_NEAR(dot[0].points[0][0], -1 / 22.0, 1e-12);
  EXPECT_NEAR(dot[0].points[1][0], 1 / 22.0, 1e-12);
  EXPECT_NEAR(dot[0].points[1][1], 0, 1e-12);
  const auto ring = *TraceDrawing(
      Picture(64, 64, [](double x, double y) { return std::abs(std::hypot(x, y) - 0.3) < 0.05; }),
      image);
  ASSERT_EQ(ring.size(), 1u);
  EXPECT_EQ(ring[0].points.front(), ring[0].points.back());
  GreyRaster negative =
      Picture(64, 64, [](double x, double y) { return std::abs(std::hypot(x, y) - 0.3) >= 0.05; });
  image.bright = true;
  const auto bright = *TraceDrawing(negative, image);
  ASSERT_EQ(bright.size(), 1u);
  EXPECT_EQ(bright[0].points, ring[0].points);
}

TEST(TraceDrawing, RefusesPicturesWithNothingToTrace) {
  EXPECT_FALSE(TraceDrawing({}, {}).ok());
  const auto blank = TraceDrawing(Picture(8, 8, [](double, double) { return false; }), {});
  EXPECT_NE(blank.status().message().find("no pixel is darker than the threshold 0.5"),
            absl::string_view::npos);
  EXPECT_FALSE(TraceDrawing(Picture(8, 8, [](double, double) { return true; }), {}).ok());
}

// S7 of the scenes: at 12 cells a stroke width, what a stamped picture marks is what it shows.
TEST(TraceDrawing, StampedOnAMeshMarksWhatThePictureShows) {
  // Lines 0.1 of 1.2 m wide, cells of 0.01 m.
  const TetMesh mesh = KuhnBox({120, 96, 1}, {1.2, 0.96, 0.01}, {-0.6, -0.48, 0});
  const double cell = 0.01;
  const auto ink = [](double x, double y) {  // of places on the slab, m
    return ToCross(x / 1.2, y / 1.2) < 0.05 || ToRing(x / 1.2, y / 1.2) < 0.05;
  };
  ImageDrawing image;
  image.keep_width = true;
  SegmentPattern pattern;
  pattern.curves = *TraceDrawing(Picture(300, 240, Drawn), image);
  pattern.scale = 1.2;
  Scene scene;
  scene.impurities.emplace();
  ImpurityLayer& layer = scene.impurities->layers.emplace_back();
  layer.source = pattern;
  layer.potency = 1;
  const auto baked = BakeImpurities(scene, mesh, BuildIncidence(mesh).edges);
  int both = 0, either = 0, wrong = 0;
  for (size_t node = 0; node < baked.potencies.size(); ++node) {
    const Vec3& at = mesh.rest_positions[node];
    const bool marked = baked.potencies[node] > 0, shown = ink(at[0], at[1]);
    both += marked && shown;
    either += marked || shown;
    if (!marked || shown) continue;
    bool near = false;  // within a cell of the drawing
    for (const double turn : {0.0, 0.8, 1.6, 2.4, 3.2, 4.0, 4.8, 5.6})
      near = near || ink(at[0] + cell * std::cos(turn), at[1] + cell * std::sin(turn));
    wrong += !near;
  }
  const double overlap = both / static_cast<double>(either);
  RecordProperty("overlap", std::to_string(overlap));
  EXPECT_GE(overlap, 0.8);
  EXPECT_LE(wrong, either / 50);
  // The control: the same picture upside down.
  std::get<SegmentPattern>(scene.impurities->layers[0].source).rotation = std::acos(-1.0);
  const auto turned = BakeImpurities(scene, mesh, BuildIncidence(mesh).edges);
  both = either = 0;
  for (size_t node = 0; node < turned.potencies.size(); ++node) {
    const bool shown = ink(mesh.rest_positions[node][0], mesh.rest_positions[node][1]);
    both += turned.potencies[node] > 0 && shown;
    either += turned.potencies[node] > 0 || shown;
  }
  EXPECT_LT(both / static_cast<double>(either), 0.5);
}

}  // namespace
}  // namespace cleave
