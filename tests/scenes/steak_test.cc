#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Steak, StrandsBridgeATearAlongItsFibres) {
  ExpectCriteria("steak", MeshLayout::kJitteredLattice);
}

TEST(FullSteak, StrandsBridgeATearAlongItsFibres) { ExpectCriteriaInFull("steak"); }

}  // namespace
}  // namespace cleave
