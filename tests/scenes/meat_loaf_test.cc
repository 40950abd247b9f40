#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(MeatLoaf, ItsShellSplitsBeforeItsCore) {
  ExpectCriteria("meat_loaf", MeshLayout::kJitteredLattice);
}

TEST(FullMeatLoaf, ItsShellSplitsBeforeItsCore) { ExpectCriteriaInFull("meat_loaf"); }

}  // namespace
}  // namespace cleave
