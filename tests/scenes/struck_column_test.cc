#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(StruckColumn, BreaksWhereItsImpuritiesAre) { ExpectCriteria("struck_column"); }

TEST(FullStruckColumn, BreaksWhereItsImpuritiesAre) { ExpectCriteriaInFull("struck_column"); }

}  // namespace
}  // namespace cleave
