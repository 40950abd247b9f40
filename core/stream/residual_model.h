#ifndef CLEAVE_CORE_STREAM_RESIDUAL_MODEL_H_
#define CLEAVE_CORE_STREAM_RESIDUAL_MODEL_H_

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace cleave {

inline constexpr size_t kClasses = 16;  // of places, by how large their residuals were
inline constexpr size_t kMasks = 8;     // which of x, y, z are not zero
inline constexpr size_t kTokens = 58;   // magnitudes, small ones each, large ones by half octaves
inline constexpr size_t kDirectTokens = 16;
inline constexpr uint32_t kFrequencyBits = 12;
inline constexpr uint32_t kFrequencyOne = 1u << kFrequencyBits;
inline constexpr int64_t kMaxMagnitude = int64_t{1} << 25;  // of a residual, steps

// A residual that is not zero as a symbol and bits that are stored as they are: the sign lowest.
struct Token {
  uint32_t symbol = 0;
  uint32_t bits = 0;
  uint32_t bit_count = 0;
};
inline Token ToToken(int32_t residual) {
  const auto sign = static_cast<uint32_t>(residual < 0);
  const auto m = static_cast<uint32_t>(std::abs(residual)) - 1;
  if (m < kDirectTokens) return {m, sign, 1};
  const auto width = static_cast<uint32_t>(std::bit_width(m));
  const uint32_t low = width - 2;
  const uint32_t symbol = kDirectTokens + 2 * (width - 5) + (m >> low & 1);
  return {symbol, (m & ((1u << low) - 1)) << 1 | sign, low + 1};
}

// How often each symbol came in each class; what the next frame's frequencies are made of.
struct SymbolCounts {
  std::array<std::array<uint64_t, kMasks>, kClasses> masks{};
  std::array<std::array<uint64_t, kTokens>, kClasses> tokens{};

  void Add(const SymbolCounts& other);
  void Fade();  // to three quarters
  bool operator==(const SymbolCounts&) const = default;
};

// Counts that stand for no experience: residuals fall off geometrically, faster in lower classes.
SymbolCounts PriorCounts();

// What coder 2 remembers of residuals; FORMAT.md, "Coder 2".
struct ResidualHistory {
  std::vector<uint16_t> activities;  // by place: decaying mean of |x| + |y| + |z|, in sixteenths
  SymbolCounts counts;
};

// The least activity of each class but the first.
inline constexpr std::array<uint32_t, kClasses - 1> kThresholds = {
    1, 2, 3, 4, 6, 9, 14, 20, 32, 48, 80, 128, 224, 448, 1024};
// The class of every activity up to the last of them.
inline constexpr std::array<uint8_t, kThresholds.back() + 1> kClassTable = [] {
  std::array<uint8_t, kThresholds.back() + 1> table{};
  uint8_t activity_class = 0;
  for (uint32_t activity = 0; activity < table.size(); ++activity) {
    if (activity == kThresholds[activity_class]) ++activity_class;
    table[activity] = activity_class;
  }
  return table;
}();

// The class of an activity, and an activity in the middle of a class.
inline uint8_t ClassOf(uint32_t activity) {
  return kClassTable[std::min(activity, kThresholds.back())];
}
uint16_t ActivityOf(uint8_t activity_class);

// The activity after residuals that add up, without signs, to `magnitude`.
inline uint16_t NextActivity(uint32_t activity, int64_t magnitude) {
  constexpr int64_t kMost = 4095;
  return static_cast<uint16_t>((3 * activity + 16 * std::min(magnitude, kMost)) >> 2);
}

// Frequencies of the symbols of an alphabet, each at least 1, together kFrequencyOne.
void ToFrequencies(const uint64_t* counts, size_t symbols, uint16_t* frequencies);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_RESIDUAL_MODEL_H_
