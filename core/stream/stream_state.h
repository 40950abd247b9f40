#ifndef CLEAVE_CORE_STREAM_STREAM_STATE_H_
#define CLEAVE_CORE_STREAM_STREAM_STATE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "core/stream/residual_model.h"
#include "core/stream/stream_header.h"

namespace cleave {

// What encoder and decoder both hold after a frame, bit for bit: all that the next frame's bytes
// depend on besides the next frame itself.
struct StreamState {
  int64_t frame = -1;  // -1: none yet
  uint32_t epoch = 0;
  double time = 0;       // s
  double tolerance = 0;  // m, of the grid that the integers are on
  int64_t fragments = 0;
  // Quantised coordinates, x, y, z of each node in the stream's order; FORMAT.md, "Quantisation".
  // With predictor 3 there are ranks (exact_positions.h) instead.
  std::vector<int32_t> positions;
  std::vector<int64_t> exact;
  // The same a frame before; only valid when has_previous. After a key frame there is none for
  // predictor 1, and predictor 2 takes the key frame's own.
  std::vector<int32_t> previous;
  std::vector<int64_t> previous_exact;
  bool has_previous = false;
  std::vector<int32_t> broken_edges;  // ascending
  // Of each place: its tolerance is that of the frame times 2 to this power. In streams with
  // regions.
  std::vector<uint8_t> shifts;
  ResidualHistory residuals;  // with coder 2
};

// Coordinates stay within this, so that a linear continuation and its residual fit.
inline constexpr int32_t kMaxQuantised = (1 << 30) - 1;

// Residuals of predictor 2 are whole steps, its coordinates 64ths of a step.
inline constexpr int32_t kUnitsPerStep = 64;

// Pieces outside of a region of interest are coarser by up to this power of two.
inline constexpr int32_t kMaxShift = 20;

// XXH3-64 of the stream header's bytes and the state; FORMAT.md, "State hash".
uint64_t HashStreamState(absl::string_view header_bytes, const StreamState& state);

// Rest positions on the grid of this step (m): floor((x - origin) / step + 0.5).
std::vector<int32_t> QuantiseRest(std::span<const Vec3> rest_positions, const Vec3& origin,
                                  double step);

// Where a linear continuation puts a coordinate.
inline int32_t PredictLinear(int32_t last, int32_t before) {
  const int64_t next = 2 * int64_t{last} - before;
  return static_cast<int32_t>(next > kMaxQuantised    ? kMaxQuantised
                              : next < -kMaxQuantised ? -kMaxQuantised
                                                      : next);
}

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_STREAM_STATE_H_
