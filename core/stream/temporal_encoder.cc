// What is apart in FrameEncoder with predictor 1: positions on a grid, from those of the last
// frames.

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"
#include "core/stream/frame_encoder.h"
#include "core/stream/position_chunk.h"
#include "core/stream/section_coder.h"

namespace cleave {
namespace {

constexpr int64_t kGrainNodes = 4096;

// Bits that a residual takes, roughly: what the choice of a prediction compares.
int ResidualBits(int64_t residual) {
  return std::bit_width(static_cast<uint64_t>(residual < 0 ? -residual : residual));
}

}  // namespace

absl::Status FrameEncoder::QuantiseOnGrid(const std::vector<Vec3>& positions) {
  const double inverse_step = 1.0 / QuantisationStep(tolerance_, header_.domain_bound);
  const Vec3 origin = header_.origin;
  constexpr double kLimit = kMaxQuantised;
  std::atomic<bool> all_fit{true};
  const auto grid = [&](const Vec3& position, size_t axis) {
    return std::floor((position[axis] - origin[axis]) * inverse_step + 0.5);
  };
  const auto fits = [&](double value) { return value >= -kLimit && value <= kLimit; };
  ParallelFor(static_cast<int64_t>(positions.size()), kGrainNodes, [&](int64_t begin, int64_t end) {
    bool fit = true;
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      for (size_t axis = 0; axis < 3; ++axis) {
        const double value = grid(positions[node], axis);
        fit &= fits(value);
        next_[3 * node + axis] = static_cast<int32_t>(fits(value) ? value : 0);
      }
    }
    if (!fit) all_fit.store(false, std::memory_order_relaxed);
  });
  if (all_fit.load()) return absl::OkStatus();
  for (size_t node = 0; node < positions.size(); ++node) {
    const Vec3& x = positions[node];
    if (fits(grid(x, 0)) && fits(grid(x, 1)) && fits(grid(x, 2))) continue;
    const double reach = kLimit / inverse_step;
    return absl::OutOfRangeError(absl::StrCat(
        "POSITION_OUT_OF_RANGE: node ", node, " at (", x[0], ", ", x[1], ", ", x[2],
        ") m is not finite or farther than ", reach, " m from (", origin[0], ", ", origin[1], ", ",
        origin[2], "), which is what a tolerance of ", tolerance_, " m can reach"));
  }
  return absl::InternalError("positions changed while they were encoded");
}

void FrameEncoder::AppendPositions(bool key, FrameHeader& header, std::string& body) const {
  const auto nodes = static_cast<int64_t>(header_.node_count);
  const auto chunk_nodes = static_cast<int64_t>(header_.chunk_nodes);
  const int64_t chunks = (nodes + chunk_nodes - 1) / chunk_nodes;
  std::vector<PositionChunk> coded(static_cast<size_t>(chunks));
  const auto encode_chunk = [&](int64_t index, std::vector<int32_t>& residuals) {
    const auto begin = static_cast<size_t>(3 * index * chunk_nodes);
    const auto end = static_cast<size_t>(3 * std::min(nodes, (index + 1) * chunk_nodes));
    PositionChunk& chunk = coded[static_cast<size_t>(index)];
    residuals.resize(end - begin);
    if (key) {
      for (size_t at = begin; at < end; ++at) residuals[at - begin] = next_[at] - rest_[at];
    } else {
      chunk.prediction = Prediction::kLast;
      if (state_.has_previous) {
        int64_t last_bits = 0;
        int64_t linear_bits = 0;
        for (size_t at = begin; at < end; ++at) {
          const int64_t last = state_.positions[at];
          last_bits += ResidualBits(next_[at] - last);
          linear_bits += ResidualBits(
              next_[at] - int64_t{PredictLinear(state_.positions[at], state_.previous[at])});
        }
        if (linear_bits < last_bits) chunk.prediction = Prediction::kLinear;
      }
      if (chunk.prediction == Prediction::kLinear) {
        for (size_t at = begin; at < end; ++at) {
          residuals[at - begin] =
              next_[at] - PredictLinear(state_.positions[at], state_.previous[at]);
        }
      } else {
        for (size_t at = begin; at < end; ++at) {
          residuals[at - begin] = next_[at] - state_.positions[at];
        }
      }
    }
    const std::string planes = ToBytePlanes(residuals);
    chunk.raw_bytes = static_cast<uint32_t>(planes.size());
    chunk.coded = CodeParts(planes, static_cast<uint32_t>(planes.size() / residuals.size()));
  };
  ParallelFor(chunks, 1, [&](int64_t begin, int64_t end) {
    std::vector<int32_t> residuals;
    for (int64_t index = begin; index < end; ++index) encode_chunk(index, residuals);
  });
  for (int64_t index = 0; index < chunks; ++index) {
    AppendPositionChunk(header_, index, coded[static_cast<size_t>(index)], header, body);
  }
}

}  // namespace cleave
