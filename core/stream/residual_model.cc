#include "core/stream/residual_model.h"

#include <cstddef>

namespace cleave {
namespace {

constexpr std::array<uint16_t, kClasses> kMiddles = {0,  1,  2,  3,   5,   7,   11,  17,
                                                     25, 39, 62, 101, 170, 316, 680, 2400};

}  // namespace

void SymbolCounts::Add(const SymbolCounts& other) {
  for (size_t c = 0; c < kClasses; ++c) {
    for (size_t s = 0; s < kMasks; ++s) masks[c][s] += other.masks[c][s];
    for (size_t s = 0; s < kTokens; ++s) tokens[c][s] += other.tokens[c][s];
  }
}

void SymbolCounts::Fade() {
  for (size_t c = 0; c < kClasses; ++c) {
    for (uint64_t& count : masks[c]) count = count * 3 / 4;
    for (uint64_t& count : tokens[c]) count = count * 3 / 4;
  }
}

// Of a class with middle activity a, a residual is zero with probability 48 / (48 + a), and every
// further step is a / (48 + a) times as likely.
SymbolCounts PriorCounts() {
  SymbolCounts prior;
  for (size_t c = 0; c < kClasses; ++c) {
    const uint64_t a = kMiddles[c];
    const uint64_t all = 48 + a;
    for (size_t mask = 0; mask < kMasks; ++mask) {
      uint64_t count = 256;
      for (size_t axis = 0; axis < 3; ++axis) {
        count *= (mask >> axis & 1) != 0 ? a : 48;
      }
      prior.masks[c][mask] = count / (all * all * all);
    }
    // The chance to reach the first m of each token, in 2^-32: by single steps, then by doubling.
    std::array<uint64_t, kTokens + 1> reach{};
    reach[0] = uint64_t{1} << 32;
    for (size_t token = 1; token <= kDirectTokens; ++token) {
      reach[token] = reach[token - 1] * a / all;
    }
    uint64_t half = reach[8];  // of the power of two before
    for (size_t token = kDirectTokens; token < kTokens; token += 2) {
      reach[token + 1] = reach[token] * half >> 32;
      reach[token + 2] = reach[token] * reach[token] >> 32;
      half = reach[token];
    }
    for (size_t token = 0; token < kTokens; ++token) {
      prior.tokens[c][token] = (reach[token] - reach[token + 1]) >> 24;
    }
  }
  return prior;
}

uint16_t ActivityOf(uint8_t activity_class) { return kMiddles[activity_class]; }

void ToFrequencies(const uint64_t* counts, size_t symbols, uint16_t* frequencies) {
  uint64_t total = 0;
  size_t most = 0;
  for (size_t s = 0; s < symbols; ++s) {
    total += counts[s];
    if (counts[s] > counts[most]) most = s;
  }
  uint64_t left = kFrequencyOne;
  for (size_t s = 0; s < symbols; ++s) {
    const uint64_t share = total == 0 ? 0 : counts[s] * (kFrequencyOne - symbols) / total;
    const uint64_t frequency = 1 + share;
    frequencies[s] = static_cast<uint16_t>(frequency);
    left -= frequency;
  }
  frequencies[most] = static_cast<uint16_t>(frequencies[most] + left);  // what rounding left
}

}  // namespace cleave
