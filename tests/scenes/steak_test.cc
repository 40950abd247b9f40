#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Steak, StrandsBridgeATearAlongItsFibres) {
  ExpectCriteria("steak", {.seed = 1, .layout = MeshLayout::kJitteredLattice, .coarseness = 2});
}

TEST(FullSteak, StrandsBridgeATearAlongItsFibres) { ExpectCriteriaInFull("steak"); }

}  // namespace
}  // namespace cleave
