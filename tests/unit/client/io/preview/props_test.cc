#include "client/io/preview/props.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cleave {
namespace {

// m^3, positive where triangles turn counter-clockwise seen from outside.
double Volume(const Prop& prop) {
  double volume = 0;
  for (const auto& t : prop.triangles) {
    const Vec3& a = prop.points[static_cast<size_t>(t[0])];
    const Vec3& b = prop.points[static_cast<size_t>(t[1])];
    const Vec3& c = prop.points[static_cast<size_t>(t[2])];
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0])) /
              6;
  }
  return volume;
}

TEST(Props, ShapesOfCollidersKeepTheirVolume) {
  const auto ball = PropOf(SphereShape{{3, 2, 1}, 0.5});
  ASSERT_TRUE(ball.has_value());
  EXPECT_NEAR(Volume(*ball) / (std::numbers::pi / 6), 1, 0.02);
  const auto box = PropOf(BoxShape{{1, 1, 1}, {1, 2, 3}, {1, 1, 0}, 0.7});
  ASSERT_TRUE(box.has_value());
  EXPECT_NEAR(Volume(*box), 6, 1e-12);
  EXPECT_FALSE(PropOf(PlaneShape{}).has_value());
}

TEST(Props, APlaceTurnsAndThenMoves) {
  auto box = PropOf(BoxShape{{2, 0, 0}, {2, 1, 1}, {0, 0, 1}, 0});
  ASSERT_TRUE(box.has_value());
  box->places[1] = {{std::sqrt(0.5), 0, 0, std::sqrt(0.5)}, {0, 0, 1}};  // a quarter turn about z
  double farthest = 0;
  for (const Vec3& point : box->PointsAt(1)) farthest = std::max(farthest, point[1]);
  EXPECT_NEAR(farthest, 3, 1e-12);
}

TEST(Props, CamerasHoldWhatComesNearTheBodyAndNoMore) {
  const std::vector<Vec3> body = {{0, 0, 0}, {1, 1, 1}};
  auto ball = PropOf(SphereShape{{0, 0, 0}, 0.1});
  ASSERT_TRUE(ball.has_value());
  ball->places[0] = {{1, 0, 0, 0}, {40, 0, 0}};
  ball->places[1] = {{1, 0, 0, 0}, {1.2, 0.5, 0.5}};
  double farthest = 0;
  const std::vector<Vec3> points = PropPointsNear(std::vector<Prop>{*ball}, body);
  EXPECT_FALSE(points.empty());
  for (const Vec3& point : points) farthest = std::max(farthest, point[0]);
  EXPECT_NEAR(farthest, 1.3, 0.01);
  const auto hall = PropOf(BoxShape{{0, 0, 0}, {10, 10, 10}, {0, 0, 1}, 0});
  EXPECT_TRUE(PropPointsNear(std::vector<Prop>{*hall}, body).empty());
}

}  // namespace
}  // namespace cleave
