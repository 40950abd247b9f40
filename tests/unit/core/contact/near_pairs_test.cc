#include "core/contact/near_pairs.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/counter_rng.h"

namespace cleave {
namespace {

using Pairs = std::vector<std::pair<int32_t, int32_t>>;

TEST(NearPairs, AreThoseThatBruteForceFinds) {
  std::vector<Eigen::Vector3d> points;
  std::vector<int32_t> groups;
  for (uint64_t k = 0; k < 400; ++k) {
    Eigen::Vector3d point;
    for (uint64_t axis = 0; axis < 3; ++axis)
      point[static_cast<int>(axis)] = UniformDraw(1, RandomStream::kNodeNoise, k, axis) - 0.5;
    points.push_back(point);
    groups.push_back(static_cast<int32_t>(k % 4) - 1);
  }
  NearPairs near;
  for (const double reach : {0.01, 0.1, 0.3, 2.0}) {
    Pairs expected;
    for (int32_t i = 0; i < 400; ++i) {
      for (int32_t j = i + 1; j < 400; ++j) {
        const auto a = static_cast<size_t>(i), b = static_cast<size_t>(j);
        if (groups[a] >= 0 && groups[b] >= 0 && groups[a] != groups[b] &&
            (points[a] - points[b]).norm() <= reach)
          expected.push_back({i, j});
      }
    }
    EXPECT_EQ(near.Find(points, groups, reach), expected) << reach;
  }
}

TEST(NearPairs, PointsThatAreNotFiniteAreNearNone) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Eigen::Vector3d> points = {
      {inf, 0, 0}, {std::nan(""), 0, 0}, {1e300, 0, 0}, {0, 0, 0}, {0.5, 0, 0}};
  EXPECT_EQ(NearPairs().Find(points, {0, 1, 2, 3, 4}, 1), (Pairs{{3, 4}}));
}

}  // namespace
}  // namespace cleave
