#include "core/scene/presets.h"

#include <gtest/gtest.h>

#include <tuple>

#include "core/probe/probe.h"

namespace cleave {
namespace {

struct Breaks {
  const char* preset;
  double modulus;   // Pa, along x
  double strength;  // Pa, nominal, along x
  double strain;    // there
};

// What the sources of the presets say, to the accuracy that a preset can claim.
TEST(MaterialPresets, BreakWhereTheirSourcesSay) {
  for (const Breaks& expected : {Breaks{"bread", 15e3, 4e3, 0.3},
                                 {"cheese", 113e3, 40e3, 0.5},
                                 {"raw_meat", 450e3, 220e3, 0.5},
                                 {"dry_wood", 11.9e9, 70e6, 0.006},
                                 {"damp_wood", 9.3e9, 39e6, 0.0045},
                                 {"rubber", 1.5e6, 3e6, 5},
                                 {"gold", 78e9, 130e6, 0.45},
                                 {"gold_copper", 100e9, 550e6, 0.40},
                                 {"porcelain", 70e9, 35e6, 0.0005},
                                 {"glass", 70e9, 45e6, 0.00064},
                                 {"concrete", 33e9, 2.9e6, 0.000088}}) {
    MaterialProbe probe;
    probe.material = FindMaterialPreset(expected.preset)->material;
    probe.pull_directions = {{1, 0, 0}};
    probe.largest_strain = 10;
    const StressStrainCurve curve = RunProbe(probe, StopFlag())->curves[0];
    EXPECT_NE(curve.end, CurveEnd::kLargestStrain) << expected.preset;
    EXPECT_NEAR(curve.youngs_modulus, expected.modulus, 0.02 * expected.modulus) << expected.preset;
    EXPECT_NEAR(curve.points.back().nominal_stress, expected.strength, 0.15 * expected.strength)
        << expected.preset;
    EXPECT_NEAR(curve.points.back().strain, expected.strain, 0.2 * expected.strain)
        << expected.preset;
  }
}

TEST(MaterialPresets, AreWeakerAcrossTheirFibres) {
  for (const auto& [preset, least, most] : {std::tuple{"raw_meat", 8e3, 12e3},
                                            {"dry_wood", 2.3e6, 2.7e6},
                                            {"damp_wood", 1.5e6, 1.8e6}}) {
    MaterialProbe probe;
    probe.material = FindMaterialPreset(preset)->material;
    probe.pull_directions = {{0, 1, 0}};
    const StressStrainCurve curve = RunProbe(probe, StopFlag())->curves[0];
    EXPECT_EQ(curve.end, CurveEnd::kTensileStrength) << preset;
    EXPECT_GT(curve.points.back().nominal_stress, least) << preset;
    EXPECT_LT(curve.points.back().nominal_stress, most) << preset;
  }
}

}  // namespace
}  // namespace cleave
