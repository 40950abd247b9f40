#ifndef CLEAVE_TESTS_SCENES_BRANCH_H_
#define CLEAVE_TESTS_SCENES_BRANCH_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A tapered branch with the stubs of two twigs, fibres along it, its foot pinned, its tip bent
// aside and pulled. Variants: "dry"; "damp", with water, which degrades, on all nodes, in patches;
// "dry-iso" and "damp-iso", without fibres; "dry-fall" and "damp-fall", of softer wood, sawn into
// above the foot, whose tip is let go when it is torn off and falls across the edge of a stone.
absl::StatusOr<Demonstration> MakeBranch(const Setting& setting);
// The same of another body along z from the origin to kBranchLength, about kBranchDiameter thick,
// of cells of that size (m), held by so much of each end (m); the setting's layout and coarseness
// count for nothing.
Demonstration MakeBranchOf(TetMesh mesh, double cell_size, const Setting& setting,
                           double grip = 0.06);
inline constexpr double kBranchLength = 0.6;      // m
inline constexpr double kBranchDiameter = 0.086;  // m, the mean

// splinter_length: axial extent of a fracture over the diameter, the mean over fractures by area.
Metrics MeasureBranch(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run);

std::vector<Criterion> BranchCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_BRANCH_H_
