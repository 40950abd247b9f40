#ifndef CLEAVE_CORE_STREAM_EXACT_POSITIONS_H_
#define CLEAVE_CORE_STREAM_EXACT_POSITIONS_H_

#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "core/base/vec3.h"
#include "core/stream/frame_header.h"
#include "core/stream/stream_header.h"
#include "core/stream/stream_state.h"

namespace cleave {

// Predictor 3 of FORMAT.md: coordinates to the bit, each as the whole number that ranks its double
// among all doubles. Differences of them wrap, so that nothing is out of range. Loops run on the
// current TBB arena.

// The rank of a double, and back: its bits, those of negative ones reversed.
inline int64_t RankOf(double value) {
  const auto bits = std::bit_cast<int64_t>(value);
  return bits ^ ((bits >> 63) & std::numeric_limits<int64_t>::max());
}
inline double OfRank(int64_t rank) {
  return std::bit_cast<double>(rank ^ ((rank >> 63) & std::numeric_limits<int64_t>::max()));
}

// x, y, z of each node. Error: OutOfRange for the first node that is not finite.
absl::Status RankPositions(std::span<const Vec3> positions, std::vector<int64_t>& ranks);

// Appends the positions sections of the frame whose ranks are `next` and that follows `state`; a
// key frame's are predicted from the ranks of `rest`.
void AppendExactPositions(const StreamHeader& stream, bool key, std::span<const int64_t> rest,
                          const StreamState& state, std::span<const int64_t> next,
                          FrameHeader& header, std::string& body);

// Decodes one such section, which fits its frame, into its part of `next`. Error: DataLoss, also
// for a coordinate that is not finite.
absl::Status DecodeExactChunk(const Section& section, std::span<const int64_t> rest,
                              const StreamState& state, std::span<int64_t> next);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_EXACT_POSITIONS_H_
