#include "core/impurity/impurity_noise.h"

#include <cmath>
#include <numbers>

#include "core/base/counter_rng.h"

namespace cleave {

double NodeNoise(uint64_t seed, int32_t node, NoiseDistribution distribution) {
  const auto draw = [&](uint64_t subindex) {
    return UniformDraw(seed, RandomStream::kNodeNoise, static_cast<uint64_t>(node), subindex);
  };
  if (distribution == NoiseDistribution::kUniform) return std::sqrt(3.0) * (2 * draw(0) - 1);
  // Box and Muller.
  return std::sqrt(-2 * std::log(draw(0))) * std::cos(2 * std::numbers::pi * draw(1));
}

}  // namespace cleave
