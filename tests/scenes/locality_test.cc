// The potency of one node, changed in an otherwise equal run (the paper's sec. 5 and Fig. 5).

#include "tests/scenes/locality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(LocalityDemonstration, AnImpurityIsFeltOnlyOnceAnEdgeOfItsNodeBreaks) {
  const Setting pure{.variant = "without", .seed = 1, .coarseness = 1.5};
  const Setting impure{.variant = "with", .seed = 1, .coarseness = 1.5};
  const auto without = Demonstrate("locality", pure);
  const auto with = Demonstrate("locality", impure);
  ASSERT_TRUE(without.ok()) << without.status();
  ASSERT_TRUE(with.ok()) << with.status();
  const LocalityOfChange change = CompareRuns(
      with->demonstration, BuildIncidence(with->demonstration.mesh), without->run, with->run);
  // Until something breaks the two move alike to the last bit, so no node accelerates more.
  ASSERT_GT(change.first_difference, 2);
  EXPECT_GT(change.new_broken_edges, 0);
  EXPECT_TRUE(change.broken_edges_are_the_nodes_own);
  // Implicit steps reach all of the body that is joined to the node, with most of it near by; the
  // other body in the mesh feels the solver's tolerance only.
  EXPECT_GT(change.largest, 0);
  EXPECT_GT(change.share_within_three_rings, 0.8);
  EXPECT_LT(change.largest_elsewhere, 1e-6 * change.largest);
}

}  // namespace
}  // namespace cleave
