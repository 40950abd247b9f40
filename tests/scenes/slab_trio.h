#ifndef CLEAVE_TESTS_SCENES_SLAB_TRIO_H_
#define CLEAVE_TESTS_SCENES_SLAB_TRIO_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// The paper's trio: a slab of 1 x 0.5 x 0.05 m, hinged at one end and pulled at the other.
// Variants: "iso"; "aniso", with fibres at 35 degrees to the pull; "impure", isotropic with a
// degraded band and a row of degraded pockets; "shuffled", the same potencies dealt out to other
// nodes; "turned", fibres at 125 degrees.
absl::StatusOr<Demonstration> MakeSlabTrio(const Setting& setting);

// center_from_pulled and trace_thickness as shares of the length, trace_angle to the direction of
// 35 degrees, strain_to_crack: from the largest strain before the first fracture to the nearest
// edge of it, in cells.
Metrics MeasureSlabTrio(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run);

std::vector<Criterion> SlabTrioCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_SLAB_TRIO_H_
