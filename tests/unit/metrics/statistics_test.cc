#include "tests/metrics/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace cleave {
namespace {

TEST(Statistics, TheMedianIsTheMiddle) {
  EXPECT_EQ(Median({3}), 3);
  EXPECT_EQ(Median({9, 1, 5}), 5);
  EXPECT_EQ(Median({4, 1, 2, 9}), 3);
}

TEST(Statistics, APercentileFollowsTheWeights) {
  const std::vector<double> values = {4, 1, 3, 2};
  EXPECT_EQ(Percentile(values, 0), 1);
  EXPECT_EQ(Percentile(values, 0.5), 2);
  EXPECT_EQ(Percentile(values, 0.9), 4);
  const std::vector<double> weights = {0.1, 0.1, 0.1, 5};
  EXPECT_EQ(Percentile(values, 0.5, weights), 2);
  EXPECT_EQ(Percentile(values, 0.01, weights), 1);
}

TEST(Statistics, SpearmanSeesOrderOnly) {
  const std::vector<double> x = {1, 2, 3, 4};
  EXPECT_DOUBLE_EQ(Spearman(x, std::vector<double>{1, 10, 11, 1000}), 1);
  EXPECT_DOUBLE_EQ(Spearman(x, std::vector<double>{8, 4, 2, 1}), -1);
  // Ranks 0, 1, 2, 3 against 0, 2, 1, 3: 1 - 6 * 2 / (4 * 15).
  EXPECT_DOUBLE_EQ(Spearman(x, std::vector<double>{1, 3, 2, 4}), 0.8);
  // Equal values share their rank: 0.5, 0.5, 2, 3.
  EXPECT_NEAR(Spearman(x, std::vector<double>{1, 1, 3, 4}), 0.9486832980505138, 1e-12);
  EXPECT_EQ(Spearman(x, std::vector<double>{7, 7, 7, 7}), 0);
}

TEST(Statistics, JaccardIsTheCommonShare) {
  const std::array<int32_t, 3> a = {1, 5, 9};
  const std::array<int32_t, 4> b = {2, 5, 9, 11};
  EXPECT_DOUBLE_EQ(Jaccard(a, b), 0.4);
  EXPECT_EQ(Jaccard(a, a), 1);
  EXPECT_EQ(Jaccard(a, {}), 0);
  EXPECT_EQ(Jaccard({}, {}), 1);
}

TEST(Statistics, GroupsDifferWhereTheirMembersLieApart) {
  // On a line: 0 to 4 against 10 to 14, and even numbers against odd ones.
  const auto apart = CompareGroups(
      10, 5,
      [](size_t i, size_t j) {
        const auto place = [](size_t k) { return static_cast<double>(k < 5 ? k : k + 5); };
        return std::abs(place(i) - place(j));
      },
      1);
  EXPECT_DOUBLE_EQ(apart.within, 2);
  EXPECT_DOUBLE_EQ(apart.between, 10);
  EXPECT_LT(apart.p, 0.02);
  const auto mixed = CompareGroups(
      10, 5,
      [](size_t i, size_t j) {
        const auto place = [](size_t k) { return static_cast<double>(k < 5 ? 2 * k : 2 * k - 9); };
        return std::abs(place(i) - place(j));
      },
      1);
  EXPECT_GT(mixed.p, 0.3);
}

TEST(Statistics, ValuesAreCountedWhereACriterionHolds) {
  const std::vector<double> values = {0.1, 0.5, 0.9};
  EXPECT_EQ(CountWhere(values, [](double value) { return value >= 0.5; }), 2);
}

}  // namespace
}  // namespace cleave
