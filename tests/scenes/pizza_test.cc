#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Pizza, ASliceLeavesAlongItsCuts) { ExpectCriteria("pizza", MeshLayout::kJitteredLattice); }

TEST(FullPizza, ASliceLeavesAlongItsCuts) { ExpectCriteriaInFull("pizza"); }

}  // namespace
}  // namespace cleave
