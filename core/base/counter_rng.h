#ifndef CLEAVE_CORE_BASE_COUNTER_RNG_H_
#define CLEAVE_CORE_BASE_COUNTER_RNG_H_

#include <cstdint>

namespace cleave {

// What a random number is for. Numbers of different streams never meet.
enum class RandomStream : uint64_t {
  kNodeNoise = 1,
  kEdgeDraw = 2,
  kMeshJitter = 3,
  kEdgeDeal = 4,
  kNoiseWave = 5,
  kPocket = 6,
};

// A uniform number in (0, 1), a pure function of its key: the same for any call order and thread.
// Source: counter-based hashing with the finaliser of splitmix64; method note, reference value rng.
inline double UniformDraw(uint64_t seed, RandomStream stream, uint64_t index, uint64_t subindex) {
  constexpr uint64_t kGolden = 0x9E3779B97F4A7C15u;
  const auto mix = [](uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  };
  uint64_t hash = mix(seed + kGolden);
  hash = mix(hash + kGolden + static_cast<uint64_t>(stream));
  hash = mix(hash + kGolden + index);
  hash = mix(hash + kGolden + subindex);
  return (static_cast<double>(hash >> 11) + 0.5) * 0x1.0p-53;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_COUNTER_RNG_H_
