#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Pizza, ASliceLeavesAlongItsCuts) {
  ExpectCriteria("pizza", {.seed = 1, .layout = MeshLayout::kJitteredLattice, .coarseness = 1.6});
}

TEST(FullPizza, ASliceLeavesAlongItsCuts) { ExpectCriteriaInFull("pizza"); }

}  // namespace
}  // namespace cleave
