#ifndef CLEAVE_TESTS_SCENES_STEAK_H_
#define CLEAVE_TESTS_SCENES_STEAK_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A steak torn apart: a superellipse slab of 0.20 x 0.12 x 0.02 m, wavy fibres along x, streaks of
// weak isotropic fat; one side pinned, the other pulled 30 degrees off x. Variants: "meat"; "iso",
// without fibres; "turned", fibres along y.
absl::StatusOr<Demonstration> MakeSteak(const Setting& setting);

// bridging: strands across the tear when half of the edges between its pieces are broken: edges
// stretched 1.3 times and more, within |cos| 0.8 of the fibres. A tear runs through much of the
// meat within a frame or two: the count is interpolated between the frame before half and
// half_open, the first past it. smallest_hold: the least of its boundary by which a piece dangled.
Metrics MeasureSteak(const Demonstration& demonstration, const Incidence& incidence,
                     const Run& run);

// A(a) counts by the normals of single facets, which scatter: of a crack along the fibres they give
// 0.3 to 0.45, of one across them 0.75.
std::vector<Criterion> SteakCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_STEAK_H_
