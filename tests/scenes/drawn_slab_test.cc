#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(DrawnSlab, BreaksAlongItsDrawing) {
  ExpectCriteria("drawn_slab", {.seed = 1, .coarseness = 1.25});
}

TEST(FullDrawnSlab, BreaksAlongItsDrawing) { ExpectCriteriaInFull("drawn_slab"); }

}  // namespace
}  // namespace cleave
