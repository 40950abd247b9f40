#include "core/stream/interpolation_decoder.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/stream/frame_motion.h"
#include "core/stream/residual_coder.h"
#include "core/stream/section_coder.h"

namespace cleave {

InterpolationDecoder::InterpolationDecoder(const StreamHeader& header, const StreamMesh& mesh)
    : header_(header), predictor_(header, mesh) {
  residuals_.resize(3 * mesh.rest_positions.size());
}

absl::Status InterpolationDecoder::DecodePlanes(const Section& section,
                                                std::span<const int32_t> moving) {
  const size_t size = 3 * moving.size();
  if (section.raw_bytes > 4 * size || (size > 0 && section.raw_bytes % size != 0)) {
    return absl::DataLossError("positions section does not fit its frame");
  }
  std::string planes(section.raw_bytes, '\0');
  const auto parts = size == 0 ? 0 : static_cast<uint32_t>(planes.size() / size);
  CLEAVE_RETURN_IF_ERROR(DecodeParts(section.coded, parts, planes));
  std::vector<int32_t> values(size);
  FromBytePlanes(planes, values);
  for (size_t at = 0; at < moving.size(); ++at) {
    std::copy_n(values.begin() + static_cast<ptrdiff_t>(3 * at), 3,
                residuals_.begin() + 3 * moving[at]);
  }
  return absl::OkStatus();
}

absl::Status InterpolationDecoder::Decode(const FrameHeader& frame,
                                          std::span<const Section> sections,
                                          const StreamState& state, StreamState& next) {
  const bool key = frame.kind == FrameKind::kKey;
  const uint64_t nodes = header_.node_count;
  const uint64_t chunk_nodes = header_.chunk_nodes;
  const uint64_t chunks = (nodes + chunk_nodes - 1) / chunk_nodes;
  if (sections.size() != 1 + chunks) {
    return absl::DataLossError(absl::StrCat(
        "frame has ", sections.size(), " sections of motion and positions; it needs ", 1 + chunks));
  }
  predictor_.Prepare(frame.tolerance, next.broken_edges, state.positions, state.previous, false);
  const Pieces& pieces = predictor_.pieces();
  const bool rans = header_.coder_id == kCoderContextRans;
  const bool fresh = key || state.residuals.fresh;
  CLEAVE_ASSIGN_OR_RETURN(
      const FrameMotion motion,
      ReadMotion(key, rans && fresh, sections[0], pieces.count(), predictor_.order().groups()));

  std::optional<ResidualCoder> coder;
  if (rans) {
    coder.emplace(state.residuals, fresh, ResidualCoder::Direction::kDecode);
    BeginResiduals(predictor_.order(), motion, state.residuals, next.residuals);
  }
  next.residuals.fresh = key;
  std::vector<SymbolCounts> counts(rans ? chunks : 0);
  std::vector<absl::Status> statuses(chunks);
  ParallelFor(static_cast<int64_t>(chunks), 1, [&](int64_t from, int64_t to) {
    std::vector<int32_t> moving;
    for (auto index = static_cast<size_t>(from); index < static_cast<size_t>(to); ++index) {
      const Section& chunk = sections[1 + index];
      const uint64_t first = index * chunk_nodes;
      const uint64_t count = std::min(chunk_nodes, nodes - first);
      if (chunk.type != SectionType::kPositions || chunk.coder != header_.coder_id ||
          chunk.prediction != Prediction::kInterpolation || chunk.first != first ||
          chunk.count != count) {
        statuses[index] = absl::DataLossError(
            absl::StrCat("positions section ", index, " does not fit its frame"));
        continue;
      }
      moving.clear();
      for (auto place = static_cast<int32_t>(first); place < static_cast<int64_t>(first + count);
           ++place) {
        if (!motion.Holds(pieces[place])) moving.push_back(place);
      }
      if (!rans) {
        statuses[index] = DecodePlanes(chunk, moving);
      } else if (chunk.raw_bytes == 0 && chunk.coded.empty()) {
        ResidualCoder::SkipZeros(moving, next.residuals.activities, counts[index]);
        for (const int32_t place : moving) std::fill_n(residuals_.begin() + 3 * place, 3, 0);
      } else if (chunk.raw_bytes != 12 * moving.size()) {
        statuses[index] = absl::DataLossError("positions section does not fit its frame");
      } else {
        statuses[index] = coder->Decode(chunk.coded, moving, residuals_, next.residuals.activities,
                                        counts[index]);
      }
    }
  });
  for (const absl::Status& status : statuses) CLEAVE_RETURN_IF_ERROR(status);
  for (const SymbolCounts& of_chunk : counts) next.residuals.counts.Add(of_chunk);

  next.positions.resize(3 * nodes);
  std::atomic<bool> all_fit{true};
  const auto choose = [&](int64_t group, std::span<const int32_t>) {
    return motion.continuations[static_cast<size_t>(group)];
  };
  const auto correct = [&](int32_t place, const Grid3& prediction) {
    const bool holds = motion.Holds(pieces[place]);
    Grid3 position{};
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t at = 3 * static_cast<size_t>(place) + axis;
      const int64_t value =
          holds ? state.positions[at] : prediction[axis] + int64_t{kUnitsPerStep} * residuals_[at];
      if (value < -kMaxQuantised || value > kMaxQuantised) {
        all_fit.store(false, std::memory_order_relaxed);
        continue;
      }
      position[axis] = static_cast<int32_t>(value);
    }
    return position;
  };
  predictor_.Run(key, state.positions, state.previous, next.positions, choose, correct);
  return all_fit.load() ? absl::OkStatus()
                        : absl::DataLossError("a decoded coordinate is out of range");
}

void InterpolationDecoder::Accept(FrameKind kind) {
  if (kind == FrameKind::kHold) {
    predictor_.Hold();
  } else {
    predictor_.Accept(kind == FrameKind::kKey);
  }
}

}  // namespace cleave
