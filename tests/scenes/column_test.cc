#include "tests/scenes/column.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Column, BreaksAlongItsSheetWithoutNewUnknowns) { ExpectCriteria("column"); }

TEST(FullColumn, BreaksAlongItsSheetWithoutNewUnknowns) { ExpectCriteriaInFull("column"); }

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
    const std::vector<Trial> trials = {{{.seed = 1}, {{"sheet", found}}}};
    for (const Criterion& criterion : ColumnCriteria()) {
      if (criterion.variants == std::vector<std::string>{"sheet"}) ExpectHolds(criterion, trials);
    }
  }
}

}  // namespace
}  // namespace cleave
