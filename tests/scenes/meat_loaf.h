#ifndef CLEAVE_TESTS_SCENES_MEAT_LOAF_H_
#define CLEAVE_TESTS_SCENES_MEAT_LOAF_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A superellipsoid of 0.25 x 0.1 x 0.1 m: a crust of bread 15 % deep, brittle and isotropic, about
// meat with fibres along x; its ends are pulled apart. Variants: "loaf"; "meat", meat throughout,
// whose outer part then is no different: the control.
absl::StatusOr<Demonstration> MakeMeatLoaf(const Setting& setting);

// first_bread and first_meat: frames in which 0.1 % of the edges wholly in them had broken;
// stretch_ratio: the median failure stretch of meat over that of bread; broken_bread, broken_meat:
// shares at the end.
Metrics MeasureMeatLoaf(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run);

std::vector<Criterion> MeatLoafCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_MEAT_LOAF_H_
