#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(SlabTrio, EachBodyBreaksItsOwnWay) { ExpectCriteria("slab_trio"); }

TEST(FullSlabTrio, EachBodyBreaksItsOwnWay) { ExpectCriteriaInFull("slab_trio"); }

}  // namespace
}  // namespace cleave
