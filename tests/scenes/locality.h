#ifndef CLEAVE_TESTS_SCENES_LOCALITY_H_
#define CLEAVE_TESTS_SCENES_LOCALITY_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// Two slabs side by side in one mesh, pulled alike. Variants: "without" impurities; "with" one, on
// a single node in the middle of the first slab; "shuffled", on some other node.
absl::StatusOr<Demonstration> MakeLocality(const Setting& setting);

// Against a run without impurities: the numbers of LocalityOfChange, as if the node in the middle
// were the impure one; own_edges 1 or 0, change_elsewhere over the largest. Where no bit differs
// before the first break, no node is accelerated more than it is without.
Metrics MeasureLocality(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run);

// How two runs that differ by one node's potency part.
struct LocalityOfChange {
  int64_t first_difference = -1;  // frame; before it all positions and broken edges are the same
  int64_t new_broken_edges = 0;   // in that frame, by the impurity
  bool broken_edges_are_the_nodes_own = false;
  // Changes of velocity in that frame, m/s.
  double largest = 0;
  double largest_elsewhere = 0;         // in the body that has no impurity
  double share_within_three_rings = 0;  // of the sum of squares, of nodes three edges away or less
  std::vector<double> speeds;           // a node each
};
LocalityOfChange CompareRuns(const Demonstration& with_impurity, const Incidence& incidence,
                             const Run& without, const Run& with);

std::vector<Criterion> LocalityCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_LOCALITY_H_
