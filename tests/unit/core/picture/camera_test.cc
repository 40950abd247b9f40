#include "core/picture/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace cleave {
namespace {

double Dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::vector<Vec3> BoxCorners(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({(i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1],
                       (i & 4) != 0 ? high[2] : low[2]});
  }
  return corners;
}

// Where a point falls in the picture, both in [-1, 1] when it is inside.
std::array<double, 2> Project(const Camera& camera, const Vec3& point) {
  const Vec3 from = {point[0] - camera.position[0], point[1] - camera.position[1],
                     point[2] - camera.position[2]};
  const double depth = Dot(camera.forward, from);
  EXPECT_GT(depth, 0);
  return {Dot(camera.right, from) / depth / camera.half_width,
          Dot(camera.up, from) / depth / camera.half_height};
}

TEST(Camera, HoldsEveryPointWithinTheMarginAndFillsThePicture) {
  const std::vector<std::vector<Vec3>> bodies = {
      BoxCorners({-1, -1, -1}, {1, 1, 1}), BoxCorners({5, 2, 0}, {25, 3, 1}),
      BoxCorners({0, 0, 0}, {0.1, 0.1, 9}), BoxCorners({-1, -1, 0}, {1, 1, 0.02})};
  for (const auto& body : bodies) {
    for (const double aspect : {0.6, 1.0, 1.8}) {
      const auto camera = FrameCamera(body, aspect, CameraOptions{});
      ASSERT_TRUE(camera.ok()) << camera.status();
      double most = 0;
      for (const Vec3& point : body) {
        const auto [x, y] = Project(*camera, point);
        most = std::max({most, std::abs(x), std::abs(y)});
      }
      EXPECT_LE(most, 0.84 + 1e-9);
      EXPECT_GE(most, 0.65);
    }
  }
}

TEST(Camera, OnATurntableSeesEverythingFromAllRound) {
  const auto body = BoxCorners({5, 2, 0}, {25, 3, 1});
  const auto still = FrameCamera(body, 1.5, CameraOptions{});
  ASSERT_TRUE(still.ok());
  const std::vector<Vec3> around = TurnedAround(body, *still, 36);
  EXPECT_EQ(around.size(), 36 * body.size());
  CameraOptions options;
  options.up = still->ground_normal;
  const auto camera = FrameCamera(around, 1.5, options);
  ASSERT_TRUE(camera.ok()) << camera.status();
  for (int step = 0; step < 72; ++step) {
    const Camera turned = Turned(*camera, 2 * std::numbers::pi * step / 72);
    EXPECT_NEAR(Dot(turned.forward, turned.ground_normal),
                Dot(camera->forward, camera->ground_normal), 1e-12);
    EXPECT_NEAR(Dot(turned.right, turned.forward), 0, 1e-12);
    for (const Vec3& point : body) {
      const auto [x, y] = Project(turned, point);
      EXPECT_LE(std::max(std::abs(x), std::abs(y)), 0.86);
    }
  }
  const Camera whole = Turned(*camera, 2 * std::numbers::pi);
  EXPECT_NEAR(whole.position[0], camera->position[0], 1e-9);
  EXPECT_NEAR(Turned(*camera, std::numbers::pi).position[0] - camera->scene_center[0],
              camera->scene_center[0] - camera->position[0], 1e-9);
}

TEST(Camera, ALongBodyLiesAcrossThePictureWhicheverWayItPoints) {
  for (const auto& body : {BoxCorners({0, 0, 0}, {9, 1, 1}), BoxCorners({0, 0, 0}, {1, 9, 1}),
                           BoxCorners({0, 0, 0}, {1, 1, 9})}) {
    const auto camera = FrameCamera(body, 1.5, CameraOptions{});
    ASSERT_TRUE(camera.ok()) << camera.status();
    const auto first = Project(*camera, body.front());
    const auto last = Project(*camera, body.back());
    EXPECT_GT(std::abs(first[0] - last[0]), 1.2);
  }
}

TEST(Camera, StandsAboveTheGroundWithTheGivenUp) {
  CameraOptions options;
  options.up = Vec3{0, 2, 0};
  options.elevation = 30;
  const auto camera = FrameCamera(BoxCorners({0, 3, 0}, {1, 4, 1}), 1, options);
  ASSERT_TRUE(camera.ok()) << camera.status();
  EXPECT_EQ(camera->ground_height, 3);
  EXPECT_GT(camera->position[1], 4);
  EXPECT_NEAR(camera->forward[1], -0.5, 1e-12);
  EXPECT_NEAR(Dot(camera->right, camera->up), 0, 1e-12);
}

TEST(Camera, APointAloneCanBeFramed) {
  const std::vector<Vec3> point = {{1, 2, 3}};
  const auto camera = FrameCamera(point, 1, CameraOptions{});
  ASSERT_TRUE(camera.ok()) << camera.status();
  EXPECT_NEAR(Project(*camera, point[0])[0], 0, 1e-6);
}

TEST(Camera, BadInputIsRefused) {
  EXPECT_FALSE(FrameCamera({}, 1, CameraOptions{}).ok());
  const std::vector<Vec3> bad = {{0, std::numeric_limits<double>::quiet_NaN(), 0}};
  EXPECT_FALSE(FrameCamera(bad, 1, CameraOptions{}).ok());
  const std::vector<Vec3> good = {{0, 0, 0}};
  EXPECT_FALSE(FrameCamera(good, 0, CameraOptions{}).ok());
  CameraOptions options;
  options.up = Vec3{0, 0, 0};
  EXPECT_FALSE(FrameCamera(good, 1, options).ok());
  options = CameraOptions{};
  options.elevation = 90;
  EXPECT_FALSE(FrameCamera(good, 1, options).ok());
}

}  // namespace
}  // namespace cleave
