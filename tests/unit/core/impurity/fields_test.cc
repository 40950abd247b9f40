#include "core/impurity/fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

TEST(NoiseValues, HaveUnitVarianceAndTheirCorrelation) {
  TetMesh points;
  points.rest_positions = {{0, 0, 0}, {0.3, 0, 0}, {0, 0.6, 0}, {0, 0, 5}};
  for (const auto distribution : {NoiseDistribution::kGaussian, NoiseDistribution::kUniform}) {
    constexpr int kSeeds = 1500;
    double sum = 0, squares = 0, largest = 0;
    std::array<double, 4> products = {0, 0, 0, 0};
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
      const auto values = NoiseValues({distribution, 0.5}, seed, points);
      sum += values[0];
      squares += values[0] * values[0];
      largest = std::max(largest, std::abs(values[0]));
      for (size_t k = 1; k < 4; ++k) products[k] += values[0] * values[k];
    }
    EXPECT_NEAR(sum / kSeeds, 0, 0.09);
    EXPECT_NEAR(squares / kSeeds, 1, 0.11);
    EXPECT_NEAR(products[3] / kSeeds, 0, 0.09);
    if (distribution == NoiseDistribution::kGaussian) {
      EXPECT_NEAR(products[1] / kSeeds, std::exp(-0.09 / 0.5), 0.11);
      EXPECT_NEAR(products[2] / kSeeds, std::exp(-0.36 / 0.5), 0.11);
    } else {
      EXPECT_LE(largest, std::sqrt(3.0));
      EXPECT_GT(largest, 1.7);
    }
  }
}

TEST(NoiseValues, OfAPlaceDoNotDependOnTheMesh) {
  const TetMesh coarse = KuhnBox({2, 2, 2}, {1, 1, 1}), fine = KuhnBox({4, 4, 4}, {1, 1, 1});
  const NoiseField field = {NoiseDistribution::kGaussian, 0.4};
  const auto some = NoiseValues(field, 7, coarse), more = NoiseValues(field, 7, fine);
  for (size_t i = 0; i < 27; ++i) {
    const size_t x = i / 9, y = i / 3 % 3, z = i % 3;
    EXPECT_EQ(some[i], more[(2 * x * 5 + 2 * y) * 5 + 2 * z]);
  }
}

TEST(BandShares, AreOneWithinBandsAndFallOffBesideThem) {
  TetMesh points;
  points.rest_positions = {{0, 0, 1}, {0, 0, 1.09}, {3, 0, 1.2}, {0, 0, 2}, {0, 0, -1.05}};
  ImpurityLayer layer;
  layer.falloff = 0.2;
  BandField bands;
  bands.position = 1;
  bands.width = 0.2;
  const auto one = BandShares(bands, layer, points);
  EXPECT_EQ(one[0], 1);
  EXPECT_EQ(one[1], 1);
  EXPECT_NEAR(one[2], 0.5, 1e-12);
  EXPECT_EQ(one[3], 0);
  bands.spacing = 1;
  const auto many = BandShares(bands, layer, points);
  EXPECT_EQ(many[3], 1);
  EXPECT_EQ(many[4], 1);
  bands.shape = BandShape::kCylinders;
  bands.spacing.reset();
  bands.position = 3;
  EXPECT_EQ(BandShares(bands, layer, points)[2], 1);
  EXPECT_EQ(BandShares(bands, layer, points)[0], 0);
  bands.shape = BandShape::kSpheres;
  bands.position = 2;
  EXPECT_EQ(BandShares(bands, layer, points)[3], 1);
}

TEST(PocketShares, AreBallsOfAnOftenSeenSizeAllOverTheBody) {
  const TetMesh mesh = KuhnBox({24, 24, 24}, {1, 1, 1});
  ImpurityLayer layer;
  PocketField field;
  field.count = 40;
  field.radius = 0.1;
  std::array<int, 2> half = {0, 0};
  const auto shares = PocketShares(field, layer, 3, mesh);
  for (size_t node = 0; node < shares.size(); ++node) {
    EXPECT_TRUE(shares[node] == 0 || shares[node] == 1);
    half[mesh.rest_positions[node][0] > 0.5] += shares[node] == 1;
  }
  // 40 balls of 0.0042 that may overlap or stick out: 8 to 16 % of all.
  const double share = (half[0] + half[1]) / static_cast<double>(shares.size());
  EXPECT_GT(share, 0.11);
  EXPECT_LT(share, 0.17);
  EXPECT_GT(half[0], 300);
  EXPECT_GT(half[1], 300);
  EXPECT_NE(PocketShares(field, layer, 4, mesh), shares);
  layer.falloff = 0.05;
  const auto soft = PocketShares(field, layer, 3, mesh);
  for (size_t node = 0; node < shares.size(); ++node) EXPECT_GE(soft[node], shares[node]);
  EXPECT_TRUE(std::any_of(soft.begin(), soft.end(), [](double s) { return s > 0 && s < 1; }));
}

}  // namespace
}  // namespace cleave
