#include "core/stream/residual_coder.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace cleave {

namespace {

constexpr size_t kOfClass = kMasks + kTokens;  // symbols

template <size_t kSymbols>
std::array<SymbolRange, kSymbols> RangesOf(const std::array<uint64_t, kSymbols>& counts) {
  std::array<uint16_t, kSymbols> frequencies;
  ToFrequencies(counts.data(), kSymbols, frequencies.data());
  std::array<SymbolRange, kSymbols> ranges;
  uint16_t start = 0;
  for (size_t symbol = 0; symbol < kSymbols; ++symbol) {
    ranges[symbol] = {start, frequencies[symbol]};
    start = static_cast<uint16_t>(start + frequencies[symbol]);
  }
  return ranges;
}

template <typename Alphabet, size_t kSymbols>
void FillAlphabet(const std::array<uint64_t, kSymbols>& counts, Alphabet& alphabet) {
  alphabet.ranges = RangesOf(counts);
  for (size_t symbol = 0; symbol < kSymbols; ++symbol) {
    std::fill_n(alphabet.symbols.begin() + alphabet.ranges[symbol].start,
                alphabet.ranges[symbol].frequency, static_cast<uint8_t>(symbol));
  }
}

}  // namespace

ResidualCoder::ResidualCoder(const ResidualHistory& history, bool key, Direction direction) {
  const SymbolCounts prior = key ? PriorCounts() : SymbolCounts();
  const SymbolCounts& counts = key ? prior : history.counts;
  if (direction == Direction::kDecode) {
    to_decode_ = std::make_unique<ToDecode>();
    for (size_t c = 0; c < kClasses; ++c) {
      FillAlphabet(counts.masks[c], to_decode_->masks[c]);
      FillAlphabet(counts.tokens[c], to_decode_->tokens[c]);
    }
    return;
  }
  to_encode_.reserve(kClasses * kOfClass);
  for (size_t c = 0; c < kClasses; ++c) {
    for (const SymbolRange range : RangesOf(counts.masks[c])) to_encode_.emplace_back(range);
    for (const SymbolRange range : RangesOf(counts.tokens[c])) to_encode_.emplace_back(range);
  }
}

std::string ResidualCoder::Encode(std::span<const int32_t> places,
                                  std::span<const Int32x4> residuals,
                                  std::span<uint16_t> activities, SymbolCounts& counts,
                                  RansWriter& writer) const {
  writer.Clear();
  uint16_t* symbols = writer.MoreSymbols(4 * places.size() + 1);  // one that may not count
  bool all_zero = true;
  for (const int32_t place : places) {
    const Int32x4 r = residuals[static_cast<size_t>(place)];
    uint16_t& activity = activities[static_cast<size_t>(place)];
    const uint8_t c = ClassOf(activity);
    const uint32_t mask = SignBits(r != 0) & 7;
    ++counts.masks[c][mask];
    *symbols++ = static_cast<uint16_t>(c * kOfClass + mask);
    if (mask == 0) {
      activity = NextActivity(activity, 0);
      continue;
    }
    all_zero = false;
    const Int32x4 sizes = r < 0 ? -r : r;
    int64_t magnitude = 0;
    if ((SignBits(sizes > static_cast<int32_t>(kDirectTokens)) & 7) == 0) {
      // Nearly all: without a branch on what is zero, which nobody could predict.
      uint32_t signs = 0;
      uint32_t sign_count = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const uint32_t there = mask >> axis & 1;
        const uint32_t token = static_cast<uint32_t>(sizes[axis]) - there;
        counts.tokens[c][token] += there;
        *symbols = static_cast<uint16_t>(c * kOfClass + kMasks + token);
        symbols += there;
        signs |= static_cast<uint32_t>(r[axis] < 0) << sign_count;
        sign_count += there;
      }
      writer.PutBits(signs, sign_count);
      magnitude = sizes[0] + sizes[1] + sizes[2];
    } else {
      for (int axis = 0; axis < 3; ++axis) {
        if (r[axis] == 0) continue;
        const Token token = ToToken(r[axis]);
        ++counts.tokens[c][token.symbol];
        *symbols++ = static_cast<uint16_t>(c * kOfClass + kMasks + token.symbol);
        writer.PutBits(token.bits, token.bit_count);
        magnitude += sizes[axis];
      }
    }
    activity = NextActivity(activity, magnitude);
  }
  writer.EndSymbols(symbols);
  return all_zero ? std::string() : writer.Finish(to_encode_);
}

absl::Status ResidualCoder::Decode(absl::string_view coded, std::span<const int32_t> places,
                                   std::span<Int32x4> residuals, std::span<uint16_t> activities,
                                   SymbolCounts& counts) const {
  RansReader reader(coded);
  for (const int32_t place : places) {
    uint16_t& activity = activities[static_cast<size_t>(place)];
    const uint8_t c = ClassOf(activity);
    const Alphabet<kMasks>& masks = to_decode_->masks[c];
    const size_t mask = masks.symbols[reader.Slot()];
    reader.Take(masks.ranges[mask]);
    ++counts.masks[c][mask];
    Int32x4 r{};
    if (mask == 0) {
      residuals[static_cast<size_t>(place)] = r;
      activity = NextActivity(activity, 0);
      continue;
    }
    const Alphabet<kTokens>& tokens = to_decode_->tokens[c];
    int64_t magnitude = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if ((mask >> axis & 1) == 0) continue;
      const size_t token = tokens.symbols[reader.Slot()];
      reader.Take(tokens.ranges[token]);
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
    residuals[static_cast<size_t>(place)] = r;
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
