#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(FibreBar, StrengthFallsWithTheAngleAndCracksFollowFibres) { ExpectCriteria("fibre_bar"); }

TEST(FullFibreBar, StrengthFallsWithTheAngleAndCracksFollowFibres) {
  ExpectCriteriaInFull("fibre_bar");
}

}  // namespace
}  // namespace cleave
