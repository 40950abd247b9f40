#include "core/stream/residual_coder.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace cleave {

template <size_t kSymbols>
void ResidualCoder::Alphabet<kSymbols>::Fill(const std::array<uint64_t, kSymbols>& counts,
                                             Direction direction) {
  std::array<uint16_t, kSymbols> frequencies;
  ToFrequencies(counts.data(), kSymbols, frequencies.data());
  if (direction == Direction::kDecode) symbols.resize(kFrequencyOne);
  uint16_t start = 0;
  for (size_t symbol = 0; symbol < kSymbols; ++symbol) {
    ranges[symbol] = {start, frequencies[symbol]};
    if (!symbols.empty())
      std::fill_n(symbols.begin() + start, frequencies[symbol], static_cast<uint8_t>(symbol));
    start = static_cast<uint16_t>(start + frequencies[symbol]);
  }
}

ResidualCoder::ResidualCoder(const ResidualHistory& history, bool fresh, Direction direction)
    : masks_(kClasses), tokens_(kClasses) {
  const SymbolCounts prior = fresh ? PriorCounts() : SymbolCounts();
  const SymbolCounts& counts = fresh ? prior : history.counts;
  for (size_t c = 0; c < kClasses; ++c) {
    masks_[c].Fill(counts.masks[c], direction);
    tokens_[c].Fill(counts.tokens[c], direction);
  }
}

void ResidualCoder::Encode(std::span<const int32_t> places, std::span<const int32_t> residuals,
                           std::span<uint16_t> activities, SymbolCounts& counts,
                           RansWriter& writer) const {
  for (const int32_t place : places) {
    const int32_t* r = residuals.data() + 3 * static_cast<size_t>(place);
    uint16_t& activity = activities[static_cast<size_t>(place)];
    const uint8_t c = ClassOf(activity);
    const auto mask = static_cast<size_t>(r[0] != 0) | static_cast<size_t>(r[1] != 0) << 1 |
                      static_cast<size_t>(r[2] != 0) << 2;
    ++counts.masks[c][mask];
    writer.PutSymbol(masks_[c].ranges[mask]);
    int64_t magnitude = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      if (r[axis] == 0) continue;
      const Token token = ToToken(r[axis]);
      ++counts.tokens[c][token.symbol];
      writer.PutSymbol(tokens_[c].ranges[token.symbol]);
      writer.PutBits(token.bits, token.bit_count);
      magnitude += std::abs(r[axis]);
    }
    activity = NextActivity(activity, magnitude);
  }
}

absl::Status ResidualCoder::Decode(absl::string_view coded, std::span<const int32_t> places,
                                   std::span<int32_t> residuals, std::span<uint16_t> activities,
                                   SymbolCounts& counts) const {
  RansReader reader(coded);
  for (const int32_t place : places) {
    int32_t* r = residuals.data() + 3 * static_cast<size_t>(place);
    uint16_t& activity = activities[static_cast<size_t>(place)];
    const uint8_t c = ClassOf(activity);
    const size_t mask = masks_[c].symbols[reader.Slot()];
    reader.Take(masks_[c].ranges[mask]);
    ++counts.masks[c][mask];
    int64_t magnitude = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      r[axis] = 0;
      if ((mask >> axis & 1) == 0) continue;
      const size_t token = tokens_[c].symbols[reader.Slot()];
      reader.Take(tokens_[c].ranges[token]);
      ++counts.tokens[c][token];
      uint32_t m = static_cast<uint32_t>(token);
      uint32_t bits = 0;
      if (token < kDirectTokens) {
        bits = reader.Bits(1);
      } else {
        const auto half_octave = static_cast<uint32_t>(token - kDirectTokens);
        const uint32_t low = 3 + half_octave / 2;
        bits = reader.Bits(low + 1);
        m = (2 + half_octave % 2) << low | bits >> 1;
      }
      const auto size = static_cast<int32_t>(m + 1);
      r[axis] = (bits & 1) != 0 ? -size : size;
      magnitude += size;
    }
    activity = NextActivity(activity, magnitude);
  }
  return reader.Finish() ? absl::OkStatus()
                         : absl::DataLossError("residuals do not end with their section");
}

void ResidualCoder::SkipZeros(std::span<const int32_t> places, std::span<uint16_t> activities,
                              SymbolCounts& counts) {
  for (const int32_t place : places) {
    uint16_t& activity = activities[static_cast<size_t>(place)];
    ++counts.masks[ClassOf(activity)][0];
    activity = NextActivity(activity, 0);
  }
}

}  // namespace cleave
