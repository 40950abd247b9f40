#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Tube, BreaksInItsRingOnlyWhereThatIsPotent) { ExpectCriteria("tube"); }

TEST(FullTube, BreaksInItsRingOnlyWhereThatIsPotent) { ExpectCriteriaInFull("tube"); }

}  // namespace
}  // namespace cleave
