#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(DuctileBar, CopperMakesGoldStretchFartherInALongerThinnerNeck) {
  ExpectCriteria("ductile_bar");
}

TEST(FullDuctileBar, CopperMakesGoldStretchFartherInALongerThinnerNeck) {
  ExpectCriteriaInFull("ductile_bar");
}

}  // namespace
}  // namespace cleave
