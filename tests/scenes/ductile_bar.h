#ifndef CLEAVE_TESTS_SCENES_DUCTILE_BAR_H_
#define CLEAVE_TESTS_SCENES_DUCTILE_BAR_H_

#include <vector>

#include "absl/strings/string_view.h"
#include "tests/scenes/demonstration.h"

namespace cleave {

// A bar of 1 x 0.1 x 0.04 m that yields, necks and is torn apart along x. Variants: "gold";
// "alloy", the same with an impurity that upgrades on all nodes, as copper does in gold; "off", the
// alloy with its impurities' model off.
absl::StatusOr<Demonstration> MakeDuctileBar(const Setting& setting);

// The same of any mesh of a bar, which is moved and scaled so that it lies along x from 0 to 1 m.
absl::StatusOr<Demonstration> MakeDuctileBarOf(TetMesh mesh, absl::string_view variant);

// elongation_at_fracture and elongation_at_separation, -1 where it did not come to that; with what
// plastic strain the grips came apart: strain_of_bar, the mean between them, strain_of_neck, that
// of the slice of 0.05 m that has most; neck_area, the smallest cross-section over that at rest in
// the frame before, neck_length, how much of the bar has less than 0.75 of its cross-section then,
// m.
Metrics MeasureDuctileBar(const Demonstration& demonstration, const Incidence& incidence,
                          const Run& run);

std::vector<Criterion> DuctileBarCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_DUCTILE_BAR_H_
