#ifndef CLEAVE_CORE_STREAM_RESIDUAL_CODER_H_
#define CLEAVE_CORE_STREAM_RESIDUAL_CODER_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/stream/rans.h"
#include "core/stream/residual_model.h"

namespace cleave {

// Coder 2: residuals of a chunk of places by their places' classes. The frequencies are those
// before the frame, so that chunks are coded independently of each other; what they contain changes
// the next frame's.
class ResidualCoder {
 public:
  // For a frame that follows `history`; if it is fresh, frequencies are the prior's.
  enum class Direction { kEncode, kDecode };
  ResidualCoder(const ResidualHistory& history, bool fresh, Direction direction);

  // Gives the writer what `places`, whose classes follow from `activities`, have in `residuals`
  // (x, y, z of each place), counts it and makes their next activities.
  void Encode(std::span<const int32_t> places, std::span<const int32_t> residuals,
              std::span<uint16_t> activities, SymbolCounts& counts, RansWriter& writer) const;

  // The reverse. Error: DataLoss.
  absl::Status Decode(absl::string_view coded, std::span<const int32_t> places,
                      std::span<int32_t> residuals, std::span<uint16_t> activities,
                      SymbolCounts& counts) const;

  // What a chunk without any residual adds: nothing is coded for it.
  static void SkipZeros(std::span<const int32_t> places, std::span<uint16_t> activities,
                        SymbolCounts& counts);

 private:
  template <size_t kSymbols>
  struct Alphabet {
    std::array<SymbolRange, kSymbols> ranges;
    std::vector<uint8_t> symbols;  // of each slot, to decode
    void Fill(const std::array<uint64_t, kSymbols>& counts, Direction direction);
  };
  std::vector<Alphabet<kMasks>> masks_;    // by class
  std::vector<Alphabet<kTokens>> tokens_;  // by class
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_RESIDUAL_CODER_H_
