#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Figure, OnlyTheArmWithTheRingComesOff) {
  ExpectCriteria("figure", {.seed = 1, .coarseness = 1.3});
}

TEST(FullFigure, OnlyTheArmWithTheRingComesOff) { ExpectCriteriaInFull("figure"); }

}  // namespace
}  // namespace cleave
