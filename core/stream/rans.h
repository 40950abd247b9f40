#ifndef CLEAVE_CORE_STREAM_RANS_H_
#define CLEAVE_CORE_STREAM_RANS_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace cleave {

// Range asymmetric numeral systems with four interleaved 32-bit states, renormalised by 16-bit
// words, and a second stream of plain bits; FORMAT.md, "Coder 2". After J. Duda, arXiv:1311.2540,
// and F. Giesen, arXiv:1402.3392.

inline constexpr size_t kRansStates = 4;
inline constexpr uint32_t kRansLow = 1u << 16;  // states stay at or above this

// A symbol's part of [0, 2^12).
struct SymbolRange {
  uint16_t start = 0;
  uint16_t frequency = 0;
};

// Collects symbols and plain bits; Finish codes them.
class RansWriter {
 public:
  void Clear();
  void PutSymbol(SymbolRange range) { symbols_.push_back(range); }
  void PutBits(uint32_t bits, uint32_t count);  // at most 26
  // u32 number of words, four states, the words, the bits.
  std::string Finish();

 private:
  std::vector<SymbolRange> symbols_;
  std::vector<uint16_t> words_;
  std::string plain_;
  uint64_t pending_ = 0;
  uint32_t pending_count_ = 0;
};

// The reverse, of bytes that nobody vouches for: what is not there reads as zero, and Finish tells.
class RansReader {
 public:
  explicit RansReader(absl::string_view coded);

  // Where in [0, 2^12) the next symbol is; then what range that symbol has.
  uint32_t Slot() const { return states_[at_] & 0xFFF; }
  void Take(SymbolRange range) {
    uint32_t& state = states_[at_];
    state = range.frequency * (state >> 12) + (state & 0xFFF) - range.start;
    if (state < kRansLow) state = state << 16 | NextWord();
    at_ = (at_ + 1) % kRansStates;
  }
  uint32_t Bits(uint32_t count) {
    while (pending_count_ < count) {
      pending_ |= uint64_t{NextByte()} << pending_count_;
      pending_count_ += 8;
    }
    const auto bits = static_cast<uint32_t>(pending_ & ((uint64_t{1} << count) - 1));
    pending_ >>= count;
    pending_count_ -= count;
    return bits;
  }
  // True if everything was there and has been used up.
  bool Finish() const;

 private:
  uint32_t NextWord();
  uint32_t NextByte();

  std::array<uint32_t, kRansStates> states_{};
  size_t at_ = 0;
  const char* words_ = nullptr;
  size_t words_left_ = 0;
  absl::string_view plain_;
  uint64_t pending_ = 0;
  uint32_t pending_count_ = 0;
  bool ok_ = true;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_RANS_H_
