#include "core/impurity/texture.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/counter_rng.h"
#include "core/impurity/bake.h"
#include "core/impurity/surface_paint.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

// Four texels: 0 and 51 above, 102 and 255 below.
SurfaceTexture Four(TextureWrap wrap) {
  SurfaceTexture texture;
  texture.width = texture.height = 2;
  texture.values = {0, 51, 102, 255};
  texture.wrap = wrap;
  return texture;
}

TEST(Texture, HasItsValuesInTheMiddleOfTexelsAndIsLinearBetween) {
  for (const TextureWrap wrap : {TextureWrap::kRepeat, TextureWrap::kClamp, TextureWrap::kMirror}) {
    SurfaceTexture texture = Four(wrap);
    EXPECT_DOUBLE_EQ(TextureShare(texture, 0.25, 0.75), 0);
    EXPECT_DOUBLE_EQ(TextureShare(texture, 0.75, 0.75), 0.2);
    EXPECT_DOUBLE_EQ(TextureShare(texture, 0.25, 0.25), 0.4);
    EXPECT_DOUBLE_EQ(TextureShare(texture, 0.75, 0.25), 1);
    EXPECT_DOUBLE_EQ(TextureShare(texture, 0.5, 0.75), 0.1);
    EXPECT_DOUBLE_EQ(TextureShare(texture, 0.5, 0.5), 0.4);
    texture.invert = true;
    EXPECT_DOUBLE_EQ(TextureShare(texture, 0.75, 0.75), 0.8);
  }
}

TEST(Texture, RepeatsEndsOrReflectsBeyondItsBorder) {
  const SurfaceTexture repeat = Four(TextureWrap::kRepeat);
  const SurfaceTexture clamp = Four(TextureWrap::kClamp);
  const SurfaceTexture mirror = Four(TextureWrap::kMirror);
  for (const double turns : {-3, -1, 1, 2}) {
    EXPECT_DOUBLE_EQ(TextureShare(repeat, 0.75 + turns, 0.25), 1);
    EXPECT_DOUBLE_EQ(TextureShare(repeat, 0.75, 0.25 + turns), 1);
  }
  EXPECT_DOUBLE_EQ(TextureShare(repeat, 1, 0.75), 0.1);  // between the last column and the first
  EXPECT_DOUBLE_EQ(TextureShare(clamp, 1, 0.75), 0.2);
  EXPECT_DOUBLE_EQ(TextureShare(clamp, 7, -7), 1);
  EXPECT_DOUBLE_EQ(TextureShare(clamp, -7, 7), 0);
  EXPECT_DOUBLE_EQ(TextureShare(mirror, 1.25, 0.25), 1);
  EXPECT_DOUBLE_EQ(TextureShare(mirror, 1.75, 0.25), 0.4);
  EXPECT_DOUBLE_EQ(TextureShare(mirror, -0.25, 0.25), 0.4);
  EXPECT_DOUBLE_EQ(TextureShare(mirror, 0.25, -0.25), 0.4);
  EXPECT_DOUBLE_EQ(TextureShare(mirror, 0.25, 1.75), 0.4);
}

// A body of 2 x 1 x 0.5 m, whose top is two triangles with a picture of 64 x 32 texels.
class PaintedBlock : public ::testing::Test {
 protected:
  PaintedBlock() : mesh_(KuhnBox({16, 8, 4}, {2, 1, 0.5})) {
    paint_.vertices = {{0, 0, 0.5}, {2, 0, 0.5}, {2, 1, 0.5}, {0, 1, 0.5}};
    paint_.triangles = {{0, 1, 2}, {0, 2, 3}};
    paint_.depth = 0.2;
    SurfaceTexture& texture = paint_.texture.emplace();
    texture.width = 64;
    texture.height = 32;
    for (uint64_t k = 0; k < 64 * 32; ++k) {
      texture.values.push_back(
          static_cast<uint8_t>(255 * UniformDraw(1, RandomStream::kMeshJitter, k, 0)));
    }
    texture.uvs = {{0, 0, 1, 0, 1, 1}, {0, 0, 1, 1, 0, 1}};
  }
  std::vector<double> Potencies() const {
    Scene scene;
    ImpurityLayer& layer = scene.impurities.emplace().layers.emplace_back();
    layer.source = paint_;
    layer.potency = 10;
    layer.falloff = 0.2;
    return BakeImpurities(scene, mesh_, {}).potencies;
  }

  TetMesh mesh_;
  SurfacePaint paint_;
};

TEST_F(PaintedBlock, EveryNodeHasTheTexelsAboveIt) {
  const SurfaceTexture& texture = *paint_.texture;
  const std::vector<double> potencies = Potencies();
  double least = 10, most = 0;
  for (size_t node = 0; node < potencies.size(); ++node) {
    const Vec3& at = mesh_.rest_positions[node];
    // Nodes stand over corners of texels: the mean of the four round it, which repeat.
    const int column = static_cast<int>(std::lround(at[0] * 32));
    const int row = static_cast<int>(std::lround((1 - at[1]) * 32));
    double sum = 0;
    for (const int i : {column + 63, column + 64}) {
      for (const int j : {row + 31, row + 32})
        sum += texture.values[static_cast<size_t>(64 * (j % 32) + i % 64)];
    }
    const double expected = 10 * sum / 4 / 255 * std::clamp((0.4 - (0.5 - at[2])) / 0.2, 0.0, 1.0);
    EXPECT_NEAR(potencies[node], expected, 1e-9) << at[0] << " " << at[1] << " " << at[2];
    if (at[2] == 0.5) {
      least = std::min(least, potencies[node]);
      most = std::max(most, potencies[node]);
    }
  }
  // The drawing is finer than the surface: its four corners alone would give all nodes one value.
  EXPECT_GT(most - least, 6);
}

TEST_F(PaintedBlock, TurnsWithItsSurface) {
  const std::vector<double> before = Potencies();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
  const auto move = [&](Vec3& point) {
    const Eigen::Vector3d to =
        turn * Eigen::Vector3d(point[0], point[1], point[2]) + Eigen::Vector3d(3, -1, 2);
    point = {to[0], to[1], to[2]};
  };
  for (Vec3& position : mesh_.rest_positions) move(position);
  for (Vec3& vertex : paint_.vertices) move(vertex);
  const std::vector<double> after = Potencies();
  for (size_t node = 0; node < before.size(); ++node)
    EXPECT_NEAR(after[node], before[node], 1e-9) << node;
}

TEST_F(PaintedBlock, HasItsPaintFromTrianglesThatAreClosestToItsNodes) {
  // The same picture on 60 x 30 pairs of triangles, and on a lid that no node is near to.
  const auto at = [](int i, int j) -> Vec3 { return {2 * i / 60.0, j / 30.0, 0.5}; };
  paint_.vertices = {{0, 0, 9}, {2, 0, 9}, {2, 1, 9}};
  paint_.triangles = {{0, 1, 2}};
  paint_.texture->uvs = {{0, 0, 1, 0, 1, 1}};
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 30; ++j) {
      for (const auto& corners : {std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1)},
                                  std::array{at(i, j), at(i + 1, j + 1), at(i, j + 1)}}) {
        const auto first = static_cast<int32_t>(paint_.vertices.size());
        paint_.triangles.push_back({first, first + 1, first + 2});
        std::array<float, 6>& uvs = paint_.texture->uvs.emplace_back();
        for (size_t k = 0; k < 3; ++k) {
          paint_.vertices.push_back(corners[k]);
          uvs[2 * k] = static_cast<float>(corners[k][0] / 2);
          uvs[2 * k + 1] = static_cast<float>(corners[k][1]);
        }
      }
    }
  }
  const std::vector<double> of_all = Potencies();
  ImpurityLayer layer;
  layer.falloff = 0.2;
  const std::vector<int32_t> kept = PaintingTriangles(paint_, layer, mesh_);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_GT(kept.front(), 0);  // not the lid
  EXPECT_LE(kept.size(), mesh_.rest_positions.size());
  const SurfacePaint all = paint_;
  paint_.triangles.clear();
  paint_.texture->uvs.clear();
  for (const int32_t triangle : kept) {
    paint_.triangles.push_back(all.triangles[static_cast<size_t>(triangle)]);
    paint_.texture->uvs.push_back(all.texture->uvs[static_cast<size_t>(triangle)]);
  }
  const std::vector<double> of_kept = Potencies();
  for (size_t node = 0; node < of_all.size(); ++node)
    EXPECT_NEAR(of_kept[node], of_all[node], 1e-6) << node;  // of coordinates in float
  // What lies deeper than paint reaches does not count: here all but the top itself.
  for (Vec3& vertex : paint_.vertices) vertex[2] += 0.1;
  paint_.depth = 0.05;
  layer.falloff = 0;
  EXPECT_TRUE(PaintingTriangles(paint_, layer, mesh_).empty());
}

}  // namespace
}  // namespace cleave
