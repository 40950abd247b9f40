#ifndef CLEAVE_TESTS_SCENES_SCENE_TESTING_H_
#define CLEAVE_TESTS_SCENES_SCENE_TESTING_H_

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include "tests/scenes/demonstration.h"

// Tests of demonstrations: short ones, of one coarse body, belong to every test run; those whose
// suite begins with "Full" have full-sized bodies of several seeds and both layouts, and the label
// "scenes". Parameters were tuned on seed 1; full ones report the others.

namespace cleave {

inline constexpr std::array<uint32_t, 5> kReportedSeeds = {2, 3, 4, 5, 6};
inline constexpr std::array<MeshLayout, 2> kLayouts = {MeshLayout::kJitteredLattice,
                                                       MeshLayout::kUnstructured};

// Runs and measures; a failure to run is a failure of the test and gives no metrics.
inline Metrics MustMeasure(const std::string& name, Setting setting, const std::string& variant) {
  setting.variant = variant;
  const auto outcome = Demonstrate(name, setting);
  EXPECT_TRUE(outcome.ok()) << name << " " << variant << ": " << outcome.status();
  return outcome.ok() ? outcome->metrics : Metrics{};
}

// Prints what a full run found, whether or not it meets its criterion.
inline void Report(const std::string& name, const Setting& setting, const Metrics& found) {
  std::printf("%s seed %u %s:", name.c_str(), setting.seed,
              setting.layout == MeshLayout::kJitteredLattice ? "lattice" : "unstructured");
  for (const auto& [key, value] : found) std::printf(" %s=%.4g", key.c_str(), value);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_SCENE_TESTING_H_
