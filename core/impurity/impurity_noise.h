#ifndef CLEAVE_CORE_IMPURITY_IMPURITY_NOISE_H_
#define CLEAVE_CORE_IMPURITY_IMPURITY_NOISE_H_

#include <cstdint>

#include "core/scene/scene.h"

namespace cleave {

// A random number of mean 0 and variance 1 for a node, by the client's id: standard normal, or
// uniform on [-sqrt(3), sqrt(3)]. A pure function of its arguments. Source: method note, section 4.
double NodeNoise(uint64_t seed, int32_t node, NoiseDistribution distribution);

}  // namespace cleave

#endif  // CLEAVE_CORE_IMPURITY_IMPURITY_NOISE_H_
