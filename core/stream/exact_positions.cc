#include "core/stream/exact_positions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"
#include "core/stream/position_chunk.h"
#include "core/stream/section_coder.h"

namespace cleave {
namespace {

// Differences and continuations modulo 2^64.
int64_t Minus(int64_t a, int64_t b) {
  return static_cast<int64_t>(static_cast<uint64_t>(a) - static_cast<uint64_t>(b));
}
int64_t Plus(int64_t a, int64_t b) {
  return static_cast<int64_t>(static_cast<uint64_t>(a) + static_cast<uint64_t>(b));
}

// What the ranks from `begin` on are predicted to be.
class Predicted {
 public:
  Predicted(Prediction by, std::span<const int64_t> rest, const StreamState& state, size_t begin)
      : linear_(by == Prediction::kLinear),
        from_((by == Prediction::kRest ? rest.data() : state.exact.data()) + begin),
        before_(linear_ ? state.previous_exact.data() + begin : nullptr) {}
  int64_t operator[](size_t at) const {
    return linear_ ? Plus(from_[at], Minus(from_[at], before_[at])) : from_[at];
  }

 private:
  bool linear_;
  const int64_t* from_;
  const int64_t* before_;
};

// Bits that the residuals take, roughly.
int64_t BitsOf(const Predicted& predicted, std::span<const int64_t> next) {
  int64_t bits = 0;
  for (size_t at = 0; at < next.size(); ++at) {
    const int64_t residual = Minus(next[at], predicted[at]);
    bits += std::bit_width(static_cast<uint64_t>(residual < 0 ? ~residual : residual));
  }
  return bits;
}

}  // namespace

absl::Status RankPositions(std::span<const Vec3> positions, std::vector<int64_t>& ranks) {
  for (size_t node = 0; node < positions.size(); ++node) {
    const Vec3& x = positions[node];
    if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])) continue;
    return absl::OutOfRangeError(absl::StrCat("POSITION_OUT_OF_RANGE: node ", node, " at (", x[0],
                                              ", ", x[1], ", ", x[2], ") m is not finite"));
  }
  ranks.resize(3 * positions.size());
  for (size_t node = 0; node < positions.size(); ++node) {
    for (size_t axis = 0; axis < 3; ++axis) ranks[3 * node + axis] = RankOf(positions[node][axis]);
  }
  return absl::OkStatus();
}

void AppendExactPositions(const StreamHeader& stream, bool key, std::span<const int64_t> rest,
                          const StreamState& state, std::span<const int64_t> next,
                          FrameHeader& header, std::string& body) {
  const auto nodes = static_cast<int64_t>(stream.node_count);
  const auto chunk_nodes = static_cast<int64_t>(stream.chunk_nodes);
  std::vector<PositionChunk> chunks(static_cast<size_t>((nodes + chunk_nodes - 1) / chunk_nodes));
  ParallelFor(static_cast<int64_t>(chunks.size()), 1, [&](int64_t from, int64_t to) {
    for (int64_t index = from; index < to; ++index) {
      PositionChunk& chunk = chunks[static_cast<size_t>(index)];
      const auto begin = static_cast<size_t>(3 * index * chunk_nodes);
      const auto end = static_cast<size_t>(3 * std::min(nodes, (index + 1) * chunk_nodes));
      const std::span<const int64_t> ranks = next.subspan(begin, end - begin);
      const auto by = [&](Prediction prediction) {
        return Predicted(prediction, rest, state, begin);
      };
      if (!key) {
        const bool continues = state.has_previous && BitsOf(by(Prediction::kLinear), ranks) <
                                                         BitsOf(by(Prediction::kLast), ranks);
        chunk.prediction = continues ? Prediction::kLinear : Prediction::kLast;
      }
      const Predicted predicted = by(chunk.prediction);
      std::vector<int64_t> residuals(ranks.size());
      for (size_t at = 0; at < ranks.size(); ++at) residuals[at] = Minus(ranks[at], predicted[at]);
      const std::string planes = ToBytePlanes(residuals);
      chunk.raw_bytes = static_cast<uint32_t>(planes.size());
      chunk.coded = CodeParts(planes, static_cast<uint32_t>(planes.size() / residuals.size()));
    }
  });
  for (int64_t index = 0; index < static_cast<int64_t>(chunks.size()); ++index) {
    AppendPositionChunk(stream, index, chunks[static_cast<size_t>(index)], header, body);
  }
}

absl::Status DecodeExactChunk(const Section& section, std::span<const int64_t> rest,
                              const StreamState& state, std::span<int64_t> next) {
  const size_t begin = 3 * size_t{section.first};
  const std::span<int64_t> ranks = next.subspan(begin, 3 * size_t{section.count});
  std::string planes(section.raw_bytes, '\0');
  if (const absl::Status status =
          DecodeParts(section.coded, static_cast<uint32_t>(planes.size() / ranks.size()), planes);
      !status.ok()) {
    return status;
  }
  FromBytePlanes(planes, ranks);
  const Predicted predicted(section.prediction, rest, state, begin);
  bool finite = true;
  for (size_t at = 0; at < ranks.size(); ++at) {
    ranks[at] = Plus(predicted[at], ranks[at]);
    finite &= std::isfinite(OfRank(ranks[at]));
  }
  return finite ? absl::OkStatus() : absl::DataLossError("a decoded coordinate is not finite");
}

}  // namespace cleave
