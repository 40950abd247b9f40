// The potency of one node, changed in an otherwise equal run (the paper's sec. 5 and Fig. 5).

#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

// Implicit steps reach all of the body that is joined to the node, with most of it near by; the
// other body in the mesh feels the solver's tolerance only.
TEST(LocalityDemonstration, AnImpurityIsFeltOnlyOnceAnEdgeOfItsNodeBreaks) {
  ExpectCriteria("locality");
}

TEST(FullLocality, AnImpurityIsFeltOnlyOnceAnEdgeOfItsNodeBreaks) {
  ExpectCriteriaInFull("locality");
}

}  // namespace
}  // namespace cleave
