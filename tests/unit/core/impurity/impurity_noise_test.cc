#include "core/impurity/impurity_noise.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace cleave {
namespace {

TEST(NodeNoise, MatchesTheReferenceValues) {
  const double gaussian[] = {0.616496519703275, -1.7062989364022842, 1.01901986204644,
                             -0.7435913428507773};
  const double uniform[] = {1.0960903425286554, -0.9712513518253518, 0.16761825398698713,
                            0.6779942688522559};
  for (int node = 0; node < 4; ++node) {
    EXPECT_NEAR(NodeNoise(0, node, NoiseDistribution::kGaussian), gaussian[node], 1e-13);
    EXPECT_NEAR(NodeNoise(0, node, NoiseDistribution::kUniform), uniform[node], 1e-13);
  }
}

// Those of the method note, of 100 000 nodes and seed 3.
TEST(NodeNoise, HasTheMomentsOfTheReferenceSample) {
  constexpr int kCount = 100000;
  const auto moments = [](NoiseDistribution distribution) {
    double sum = 0, squares = 0;
    for (int node = 0; node < kCount; ++node) {
      const double noise = NodeNoise(3, node, distribution);
      sum += noise;
      squares += noise * noise;
    }
    const double mean = sum / kCount;
    return std::array<double, 2>{mean, std::sqrt(squares / kCount - mean * mean)};
  };
  const auto [mean, deviation] = moments(NoiseDistribution::kGaussian);
  EXPECT_NEAR(mean, -0.001581132901615143, 1e-13);
  EXPECT_NEAR(deviation, 1.000671292814437, 1e-12);
  EXPECT_NEAR(moments(NoiseDistribution::kUniform)[1], 0.9985357913450277, 1e-12);
}

TEST(NodeNoise, HasMeanZeroAndVarianceOne) {
  for (const NoiseDistribution distribution :
       {NoiseDistribution::kGaussian, NoiseDistribution::kUniform}) {
    double sum = 0, squares = 0;
    constexpr int kCount = 100000;
    for (int node = 0; node < kCount; ++node) {
      const double noise = NodeNoise(0, node, distribution);
      sum += noise;
      squares += noise * noise;
    }
    EXPECT_NEAR(sum / kCount, 0, 0.01);
    EXPECT_NEAR(std::sqrt(squares / kCount), 1, 0.005);
  }
}

}  // namespace
}  // namespace cleave
