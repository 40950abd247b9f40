#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(StruckColumn, BreaksWhereItsImpuritiesAre) {
  ExpectCriteria("struck_column", {.seed = 1, .coarseness = 1.7});
}

TEST(FullStruckColumn, BreaksWhereItsImpuritiesAre) { ExpectCriteriaInFull("struck_column"); }

}  // namespace
}  // namespace cleave
