#ifndef CLEAVE_TESTS_SCENES_FIBRE_BAR_H_
#define CLEAVE_TESTS_SCENES_FIBRE_BAR_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// The sign test of Eq. 6: a bar of 1 x 0.3 x 0.3 m with fibres at 0, 30, 60 or 90 degrees to the
// pull, in the x-y plane. Variants: "fibre0" ... "fibre90"; "iso0" ... "iso90", the same without
// fibres, whose crack is held against that direction; "plain30" and "plain60", with the same fibres
// but one threshold for edges of all directions; "stiff30" and "stiff60", as these, fibres of ten
// times the modulus of the rest instead of three.
absl::StatusOr<Demonstration> MakeFibreBar(const Setting& setting);
Metrics MeasureFibreBar(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run);

// A(a) counts by smoothed normals: those of single facets scatter so much that the criterion's 0.6
// at 60 degrees lies below what a crack exactly along the fibres has.
std::vector<Criterion> FibreBarCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_FIBRE_BAR_H_
