#ifndef CLEAVE_TESTS_SCENES_SLAB_TRIO_H_
#define CLEAVE_TESTS_SCENES_SLAB_TRIO_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// The paper's trio: a slab of 1 x 0.5 x 0.05 m, hinged at one end and pulled at the other.
// Variants: "iso"; "aniso", with fibres at 45 degrees to the pull; "impure", isotropic with a
// degraded band and a row of degraded pockets; "shuffled", the same potencies dealt out to other
// nodes; "turned", fibres at 135 degrees; "plain", pulled as slowly as those with fibres and
// between tabs like theirs, but isotropic; "projected", isotropic with the edge-projected
// reformulation; "scored", the same with a weak line across it and tabs; "ruled", the same with
// weak lines across it every 40 mm, pulled more slowly; "projected-coarse" and "ruled-coarse",
// with cells twice as long.
absl::StatusOr<Demonstration> MakeSlabTrio(const Setting& setting);

// center_from_pulled and trace_thickness as shares of the length, trace_angle to the direction of
// 45 degrees, strain_to_crack: from the largest strain before the first fracture to the nearest
// edge of it, in cells; secondary_cracks: how many there are beside the largest. And what a solve
// takes, of which steps have one and one more for each break pass: Newton iterations, and
// iterations of the linear solve in each. Criteria go by these, not by seconds_per_solve, which on
// a busy machine tells of others; what either iteration costs with fibres or impurities is in
// `cleave_bench ratios`.
//
// Of projected, scored, ruled and turned ones, against the same body without fibres and with
// uniform weakening: common_edges, the edges broken in both, of those broken in either;
// common_crack, the share of the broken ones with a broken one of the other within a cell of full
// size. Where nothing says where a slab breaks, two cracks run side by side: half a cell apart they
// have no edge in common, and so have two that approach each other under refinement. The criterion
// of projected ones is therefore about common_crack, those of scored and ruled ones, which break
// along lines, about common_edges. With a single line cells of any size find it; with many, only
// cells that tell them apart.
Metrics MeasureSlabTrio(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run);

std::vector<Criterion> SlabTrioCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_SLAB_TRIO_H_
