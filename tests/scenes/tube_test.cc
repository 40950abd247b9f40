#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Tube, BreaksInItsRingOnlyWhereThatIsPotent) {
  ExpectCriteria("tube", {.seed = 1, .coarseness = 1.6});
}

TEST(FullTube, BreaksInItsRingOnlyWhereThatIsPotent) { ExpectCriteriaInFull("tube"); }

}  // namespace
}  // namespace cleave
