#include <gtest/gtest.h>

#include <cstdio>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Column, BreaksAlongItsSheetWithoutNewUnknowns) {
  const Setting setting{.seed = 1, .coarseness = 2};
  const Metrics sheet = MustMeasure("column", setting, "sheet");
  ASSERT_FALSE(sheet.empty());
  EXPECT_EQ(sheet.at("unknowns_first"), sheet.at("unknowns_last"));
  EXPECT_EQ(sheet.at("pieces"), 2);
  EXPECT_LE(sheet.at("crack_distance"), 1.5);
  EXPECT_GE(sheet.at("lift"), 5);
  const Metrics plain = MustMeasure("column", setting, "plain");
  ASSERT_FALSE(plain.empty());
  // Elsewhere, as far as so short a body allows at this size.
  EXPECT_GT(plain.at("crack_distance"), 3);
}

// Times are printed and not asserted.
TEST(FullColumn, HasTheSameUnknownsInEveryFrame) {
  std::printf("threads  tets  unknowns first/last  s/frame  assembly  linear  fracture\n");
  for (const int threads : {1, 2}) {
    const auto outcome = Demonstrate("column", Setting{.variant = "sheet", .seed = 1}, threads);
    ASSERT_TRUE(outcome.ok()) << outcome.status();
    const Metrics& found = outcome->metrics;
    std::printf("%d  %.0f  %.0f/%.0f  %.3f  %.3f  %.3f  %.3f\n", threads, found.at("tets"),
                found.at("unknowns_first"), found.at("unknowns_last"),
                found.at("seconds_per_frame"), found.at("assembly_seconds"),
                found.at("linear_solve_seconds"), found.at("fracture_seconds"));
    EXPECT_EQ(found.at("unknowns_first"), found.at("unknowns_last"));
    EXPECT_EQ(found.at("pieces"), 2);
    EXPECT_LE(found.at("crack_distance"), 1.5);
  }
}

}  // namespace
}  // namespace cleave
