#ifndef CLEAVE_TESTS_SCENES_NOISE_MODELS_H_
#define CLEAVE_TESTS_SCENES_NOISE_MODELS_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// The tube with a ring that breaks in it and at its ends, with noise. Variants: "gaussian-1" to
// "gaussian-10"; "uniform-1" to "uniform-10", of the same variance; "strong-1" to "strong-10",
// Gaussian of nine times the variance. The number is the noise's seed; all have one mesh.
absl::StatusOr<Demonstration> MakeNoiseModels(const Setting& setting);

// damage_000 and so on: broken share of the edges in each of 20 lengths and 4 quarters of the tube.
Metrics MeasureNoiseModels(const Demonstration& demonstration, const Incidence& incidence,
                           const Run& run);

std::vector<Criterion> NoiseModelsCriteria();
std::vector<std::string> NoiseModelsVariants();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_NOISE_MODELS_H_
