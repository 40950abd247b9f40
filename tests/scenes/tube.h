#ifndef CLEAVE_TESTS_SCENES_TUBE_H_
#define CLEAVE_TESTS_SCENES_TUBE_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A brittle tube along x, 4 m long, of radii 0.5 and 0.35 m, with impurities in a ring of 0.8 m
// about its middle; its ends are pulled apart. Variants: "1" to "5", the potency of the ring
// from least to most; "shuffled", as "5" with the same potencies dealt out to other nodes; "pure",
// without a ring.
absl::StatusOr<Demonstration> MakeTube(const Setting& setting);

// break_sites: places along the tube, more than 0.1 of its length apart, each with at least a tenth
// of the crack; band_share of the ring is among the common metrics.
Metrics MeasureTube(const Demonstration& demonstration, const Incidence& incidence, const Run& run);

std::vector<Criterion> TubeCriteria();

// The tube with a ring of that potency and noise, for other scenes. `seed` is of the impurities,
// that of `setting` of the mesh.
absl::StatusOr<Demonstration> MakeTubeOf(const Setting& setting, double cell_size,
                                         const Impurities& impurities, uint32_t seed);
inline constexpr double kTubeLength = 4;  // m, its middle at the origin

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_TUBE_H_
