#ifndef CLEAVE_TESTS_SCENES_STRUCK_COLUMN_H_
#define CLEAVE_TESTS_SCENES_STRUCK_COLUMN_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A porcelain column with base and capital, its foot held, struck above its middle by a steel ball
// of 0.2 m at 5 m/s. Variants: "sheet", with one oblique stroke of a laser right through it;
// "voronoi", with the walls of a ring of Voronoi cells drawn on its side where the ball strikes
// and pushed inward to the axis, a stroke each; "plain", without impurities, which breaks
// elsewhere; "sheet-shuffled" and "voronoi-shuffled", what the strokes do dealt out to other nodes.
absl::StatusOr<Demonstration> MakeStruckColumn(const Setting& setting);

// crack_distance, crack_nearest: the 90th and the 10th percentile of the distance between crack and
// sheet, in cells. plastic_strain: the largest; 0 where nothing flows. A plain column's lift counts
// by the walls that "voronoi" has.
Metrics MeasureStruckColumn(const Demonstration& demonstration, const Incidence& incidence,
                            const Run& run);

std::vector<Criterion> StruckColumnCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_STRUCK_COLUMN_H_
