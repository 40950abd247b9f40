#ifndef CLEAVE_TESTS_SCENES_DRAWN_SLAB_H_
#define CLEAVE_TESTS_SCENES_DRAWN_SLAB_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A ductile slab of 1 x 1 x 0.05 m, both ends pulled along x, with drawings/spiral.png pushed
// through it as a pattern: two arms of a spiral that meet in the middle and lead to the free sides,
// so that the whole of it lies between the grips. Variants: "drawn"; "turned", the drawing turned
// by 90 degrees, held against the drawing as it was; "shuffled", its impurities dealt out to other
// nodes; "plain", without.
absl::StatusOr<Demonstration> MakeDrawnSlab(const Setting& setting);

// Of edges by their midpoints, within a cell of the drawing: near_drawing, the share of broken
// ones; near_base, of all but those within a grip; drawing_lift, the quotient. drawing_broken: the share of the drawing's
// length with a broken edge within a cell.
Metrics MeasureDrawnSlab(const Demonstration& demonstration, const Incidence& incidence,
                         const Run& run);

std::vector<Criterion> DrawnSlabCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_DRAWN_SLAB_H_
