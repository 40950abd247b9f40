#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(DrawnSlab, BreaksAlongItsDrawing) { ExpectCriteria("drawn_slab"); }

TEST(FullDrawnSlab, BreaksAlongItsDrawing) { ExpectCriteriaInFull("drawn_slab"); }

}  // namespace
}  // namespace cleave
