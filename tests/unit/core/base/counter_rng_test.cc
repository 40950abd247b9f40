#include "core/base/counter_rng.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cleave {
namespace {

// The values of the method note's reference table.
TEST(UniformDraw, MatchesTheReferenceTable) {
  EXPECT_NEAR(UniformDraw(0, RandomStream::kNodeNoise, 0, 0), 0.8164140271575342, 1e-15);
  EXPECT_NEAR(UniformDraw(0, RandomStream::kNodeNoise, 0, 1), 0.9595864543180406, 1e-15);
  EXPECT_NEAR(UniformDraw(1, RandomStream::kEdgeDraw, 3, 7), 0.1014178617419857, 1e-15);
  EXPECT_NEAR(UniformDraw(12345, RandomStream::kEdgeDraw, 0, 99999), 0.8540611102083009, 1e-15);
  EXPECT_NEAR(UniformDraw(uint64_t{1} << 63, RandomStream::kNodeNoise, 5, 0), 0.17037578527001213,
              1e-15);
}

TEST(UniformDraw, HasMeanOneHalfAndTheVarianceOfAUniform) {
  const int count = 100000;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double u = UniformDraw(7, RandomStream::kMeshJitter, static_cast<uint64_t>(i), 0);
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  const double mean = sum / count;
  EXPECT_NEAR(mean, 0.5, 0.005);
  EXPECT_NEAR(squares / count - mean * mean, 1.0 / 12, 0.002);
}

}  // namespace
}  // namespace cleave
