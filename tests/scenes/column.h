#ifndef CLEAVE_TESTS_SCENES_COLUMN_H_
#define CLEAVE_TESTS_SCENES_COLUMN_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A porcelain column with base and capital, 40k tets, an oblique sheet of impurities across it; its
// base is pinned, its capital pulled up and a little aside until it breaks: what a frame costs, and
// that no unknowns are added, where the paper compares with an extended finite element method.
// Variants: "sheet"; "plain", without impurities, which breaks elsewhere.
absl::StatusOr<Demonstration> MakeColumn(const Setting& setting);

// crack_distance: the 90th percentile of the distance between crack and sheet, in cells.
// unknowns_first, unknowns_last: coordinates of nodes in the first and last frame. And seconds a
// frame, by stage.
Metrics MeasureColumn(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run);

std::vector<Criterion> ColumnCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_COLUMN_H_
