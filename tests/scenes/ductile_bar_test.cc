#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(DuctileBar, CopperMakesGoldStretchFartherInALongerThinnerNeck) {
  ExpectCriteria("ductile_bar", {.seed = 1, .coarseness = 2.6});
}

TEST(FullDuctileBar, CopperMakesGoldStretchFartherInALongerThinnerNeck) {
  ExpectCriteriaInFull("ductile_bar");
}

}  // namespace
}  // namespace cleave
