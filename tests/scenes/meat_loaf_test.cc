#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(MeatLoaf, ItsShellSplitsBeforeItsCore) {
  ExpectCriteria("meat_loaf",
                 {.seed = 1, .layout = MeshLayout::kJitteredLattice, .coarseness = 1.9});
}

TEST(FullMeatLoaf, ItsShellSplitsBeforeItsCore) { ExpectCriteriaInFull("meat_loaf"); }

}  // namespace
}  // namespace cleave
