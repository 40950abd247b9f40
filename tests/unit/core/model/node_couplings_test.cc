#include "core/model/node_couplings.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

constexpr double kEntries[3][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};  // by columns

std::vector<Double4> Block() {
  std::vector<Double4> block;
  for (const auto& column : kEntries) block.push_back(Double4{column[0], column[1], column[2], 0});
  return block;
}

TEST(NodeCouplings, ACouplingStandsTransposedInTheOtherRow) {
  NodeCouplings couplings;
  couplings.AddCoupling(5, 2, Block().data());
  couplings.Gather();
  const auto rows = couplings.Rows(0, 6);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].row, 2);
  EXPECT_EQ(rows[0].column, 5);
  EXPECT_EQ(rows[1].row, 5);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_EQ(rows[1].columns[j][i], kEntries[j][i]);
      EXPECT_EQ(rows[0].columns[i][j], kEntries[j][i]);
    }
    EXPECT_EQ(rows[0].columns[i][3], 0);
  }
}

TEST(NodeCouplings, RowsAreThoseAskedForInOrder) {
  NodeCouplings couplings;
  for (const int32_t node : {7, 3, 9, 3}) couplings.AddNode(node, Block().data());
  couplings.Gather();
  EXPECT_EQ(couplings.Rows(0, 3).size(), 0u);
  EXPECT_EQ(couplings.Rows(3, 4).size(), 2u);
  EXPECT_EQ(couplings.Rows(4, 9).size(), 1u);
  EXPECT_EQ(couplings.Rows(0, 10).back().row, 9);
  couplings.Clear();
  EXPECT_TRUE(couplings.empty());
}

TEST(NodeCouplings, NoTranslationStretchesASpring) {
  NodeCouplings couplings;
  const Double4 block[3] = {{2, 1, 0, 0}, {1, 3, -1, 0}, {0, -1, 4, 0}};
  couplings.AddSpring(0, 1, block);
  couplings.Gather();
  Double4 force[2] = {Splat(0), Splat(0)};
  for (const auto& entry : couplings.Rows(0, 2)) {
    for (int k = 0; k < 3; ++k) force[entry.row] += entry.columns[k] * 2.5;
  }
  EXPECT_EQ(couplings.Rows(0, 2).size(), 4u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(force[0][k], 0);
    EXPECT_EQ(force[1][k], 0);
  }
}

}  // namespace
}  // namespace cleave
