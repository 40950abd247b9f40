#include <gtest/gtest.h>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(NoiseModels, UniformAndGaussianNoiseOfOneVarianceBreakAlike) {
  ExpectCriteria("noise_models");
}

TEST(FullNoiseModels, UniformAndGaussianNoiseOfOneVarianceBreakAlike) {
  ExpectCriteriaInFull("noise_models");
}

}  // namespace
}  // namespace cleave
