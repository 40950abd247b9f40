#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Figure, OnlyTheArmWithTheRingComesOff) {
  ExpectCriteria("figure", MeshLayout::kJitteredLattice);
}

TEST(FullFigure, OnlyTheArmWithTheRingComesOff) { ExpectCriteriaInFull("figure"); }

}  // namespace
}  // namespace cleave
