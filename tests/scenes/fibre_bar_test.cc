#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(FibreBar, StrengthFallsWithTheAngleAndCracksFollowFibres) {
  ExpectCriteria("fibre_bar", {.seed = 1, .coarseness = 1.4});
}

TEST(FullFibreBar, StrengthFallsWithTheAngleAndCracksFollowFibres) {
  ExpectCriteriaInFull("fibre_bar");
}

}  // namespace
}  // namespace cleave
