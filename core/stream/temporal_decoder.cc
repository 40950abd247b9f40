// What is apart in FrameDecoder with predictors 1 and 3: positions from those of the last frames.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/stream/exact_positions.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/section_coder.h"

namespace cleave {

absl::Status FrameDecoder::DecodeChunk(const Section& section, const std::vector<int32_t>& rest,
                                       std::vector<int32_t>& positions) const {
  const size_t begin = 3 * size_t{section.first};
  const size_t size = 3 * size_t{section.count};
  std::string planes(section.raw_bytes, '\0');
  CLEAVE_RETURN_IF_ERROR(
      DecodeParts(section.coded, static_cast<uint32_t>(planes.size() / size), planes));
  const std::span<int32_t> values(positions.data() + begin, size);
  FromBytePlanes(planes, values);
  bool fit = true;
  const auto add = [&](size_t at, int32_t prediction) {
    const int64_t value = int64_t{prediction} + values[at];
    fit &= value >= -kMaxQuantised && value <= kMaxQuantised;
    values[at] = static_cast<int32_t>(value);
  };
  switch (section.prediction) {
    case Prediction::kRest:
      for (size_t at = 0; at < size; ++at) add(at, rest[begin + at]);
      break;
    case Prediction::kLast:
      for (size_t at = 0; at < size; ++at) add(at, state_.positions[begin + at]);
      break;
    case Prediction::kLinear:
      for (size_t at = 0; at < size; ++at) {
        add(at, PredictLinear(state_.positions[begin + at], state_.previous[begin + at]));
      }
      break;
    case Prediction::kNone:
    case Prediction::kInterpolation:
      fit = false;
      break;
  }
  return fit ? absl::OkStatus() : absl::DataLossError("a decoded coordinate is out of range");
}

absl::Status FrameDecoder::DecodePositions(const FrameParts& parts, size_t section,
                                           StreamState& next) const {
  const bool key = parts.header.kind == FrameKind::kKey;
  const uint64_t nodes = header_.node_count;
  const std::span<const Section> chunks = std::span(parts.sections).subspan(section);
  const uint64_t expected = (nodes + header_.chunk_nodes - 1) / header_.chunk_nodes;
  const uint64_t widest = 3 * (exact() ? sizeof(int64_t) : sizeof(int32_t));
  if (chunks.size() != expected) {
    return absl::DataLossError(
        absl::StrCat("frame has ", chunks.size(), " sections of positions; it needs ", expected));
  }
  for (uint64_t index = 0; index < expected; ++index) {
    const Section& chunk = chunks[index];
    const uint64_t first = index * header_.chunk_nodes;
    const uint64_t count = std::min<uint64_t>(header_.chunk_nodes, nodes - first);
    if (chunk.coder != header_.coder_id) {
      return absl::UnimplementedError(absl::StrCat("section coder ", chunk.coder, " is not known"));
    }
    const bool predicted =
        key ? chunk.prediction == Prediction::kRest
            : chunk.prediction == Prediction::kLast ||
                  (chunk.prediction == Prediction::kLinear && state_.has_previous);
    if (chunk.type != SectionType::kPositions || chunk.first != first || chunk.count != count ||
        chunk.raw_bytes % (3 * count) != 0 || chunk.raw_bytes > widest * count || !predicted) {
      return absl::DataLossError(
          absl::StrCat("positions section ", index, " does not fit its frame"));
    }
  }
  if (exact()) {
    next.exact.resize(3 * nodes);
  } else {
    next.positions.resize(3 * nodes);
  }
  std::vector<absl::Status> statuses(expected);
  ParallelFor(static_cast<int64_t>(expected), 1, [&](int64_t begin, int64_t end) {
    for (auto index = static_cast<size_t>(begin); index < static_cast<size_t>(end); ++index) {
      statuses[index] = exact() ? DecodeExactChunk(chunks[index], exact_rest_, state_, next.exact)
                                : DecodeChunk(chunks[index], rest_, next.positions);
    }
  });
  for (const absl::Status& status : statuses) CLEAVE_RETURN_IF_ERROR(status);
  return absl::OkStatus();
}

}  // namespace cleave
