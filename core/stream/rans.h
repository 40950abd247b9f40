#ifndef CLEAVE_CORE_STREAM_RANS_H_
#define CLEAVE_CORE_STREAM_RANS_H_

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
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

// The same as an encoder wants it: states are divided by multiplication.
struct RansSymbol {
  RansSymbol() = default;
  explicit RansSymbol(SymbolRange range)
      : reciprocal((uint64_t{1} << 63) / range.frequency + 1),
        limit(uint32_t{range.frequency} << 20),
        complement(static_cast<uint16_t>(4096 - range.frequency)),
        start(range.start) {}

  uint64_t reciprocal = 0;  // above 2^63 / frequency: exact for states of 32 bits
  uint32_t limit = 0;       // states from here on give off a word first
  uint16_t complement = 0;
  uint16_t start = 0;
};

// Collects symbols and plain bits; Finish codes them. Keeps its memory from one use to the next.
class RansWriter {
 public:
  void Clear();
  // Room for this many symbols more, where the caller writes them: numbers in the table that Finish
  // gets. EndSymbols says how far it came.
  uint16_t* MoreSymbols(size_t most);
  void EndSymbols(const uint16_t* end) { count_ = static_cast<size_t>(end - symbols_.data()); }
  // At most 32 bits, those above `count` zero.
  void PutBits(uint32_t bits, uint32_t count) {
    pending_ |= uint64_t{bits} << pending_count_;
    pending_count_ += count;
    if (pending_count_ >= 32) FlushWord();
  }
  // u32 number of words, four states, the words, the bits.
  std::string Finish(std::span<const RansSymbol> table);

 private:
  void FlushWord();

  std::vector<uint16_t> symbols_;
  size_t count_ = 0;
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
  // At most 32.
  uint32_t Bits(uint32_t count) {
    if (pending_count_ < count) Refill(count);
    const auto bits = static_cast<uint32_t>(pending_ & ((uint64_t{1} << count) - 1));
    pending_ >>= count;
    pending_count_ -= count;
    return bits;
  }
  // True if everything was there and has been used up.
  bool Finish() const;

 private:
  uint32_t NextWord() {
    if (words_left_ == 0) {
      ok_ = false;
      return 0;
    }
    uint16_t word = 0;
    std::memcpy(&word, words_, sizeof(word));
    words_ += sizeof(word);
    --words_left_;
    return word;
  }
  void Refill(uint32_t count);

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
