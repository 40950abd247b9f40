#ifndef CLEAVE_CORE_STREAM_RESIDUAL_CODER_H_
#define CLEAVE_CORE_STREAM_RESIDUAL_CODER_H_

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/base/int4.h"
#include "core/stream/rans.h"
#include "core/stream/residual_model.h"

namespace cleave {

// Coder 2: residuals of a chunk of places by their places' classes. The frequencies are those
// before the frame, so that chunks are coded independently of each other; what they contain changes
// the next frame's.
class ResidualCoder {
 public:
  // For a frame that follows `history`; in a key frame, `key`, frequencies are the prior's.
  enum class Direction { kEncode, kDecode };
  ResidualCoder(const ResidualHistory& history, bool key, Direction direction);

  // Codes what `places`, whose classes follow from `activities`, have in `residuals` (x, y, z of
  // each place and 0), counts it and makes their next activities. Nothing if all are zero. `writer`
  // is scratch.
  std::string Encode(std::span<const int32_t> places, std::span<const Int32x4> residuals,
                     std::span<uint16_t> activities, SymbolCounts& counts,
                     RansWriter& writer) const;

  // The reverse. Error: DataLoss.
  absl::Status Decode(absl::string_view coded, std::span<const int32_t> places,
                      std::span<Int32x4> residuals, std::span<uint16_t> activities,
                      SymbolCounts& counts) const;

  // Of a mask, or of kMasks + a token, in a class, in 1/kFrequencyOne. To encode only.
  size_t Frequency(size_t activity_class, size_t symbol) const {
    return kFrequencyOne - to_encode_[activity_class * (kMasks + kTokens) + symbol].complement;
  }

  // What a chunk without any residual adds: nothing is coded for it.
  static void SkipZeros(std::span<const int32_t> places, std::span<uint16_t> activities,
                        SymbolCounts& counts);

 private:
  template <size_t kSymbols>
  struct Alphabet {
    std::array<SymbolRange, kSymbols> ranges;
    std::array<uint8_t, kFrequencyOne> symbols;  // of each slot
  };
  struct ToDecode {
    std::array<Alphabet<kMasks>, kClasses> masks;
    std::array<Alphabet<kTokens>, kClasses> tokens;
  };
  std::vector<RansSymbol> to_encode_;    // of each class in turn the masks, then the tokens
  std::unique_ptr<ToDecode> to_decode_;  // one of the two is there
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_RESIDUAL_CODER_H_
