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
  residuals_.resize(mesh.rest_positions.size());
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
    const int32_t* r = values.data() + 3 * at;
    residuals_[static_cast<size_t>(moving[at])] = Int32x4{r[0], r[1], r[2], 0};
  }
  return absl::OkStatus();
}

absl::Status InterpolationDecoder::Decode(const FrameHeader& frame,
                                          std::span<const Section> sections, StreamState& state,
                                          StreamState& next) {
  shown_.clear();
  const bool key = frame.kind == FrameKind::kKey;
  const uint64_t nodes = header_.node_count;
  const uint64_t chunk_nodes = header_.chunk_nodes;
  const uint64_t chunks = (nodes + chunk_nodes - 1) / chunk_nodes;
  if (sections.size() != 1 + chunks) {
    return absl::DataLossError(absl::StrCat(
        "frame has ", sections.size(), " sections of motion and positions; it needs ", 1 + chunks));
  }
  predictor_.Prepare(key, frame.tolerance, next.broken_edges, state.positions, state.previous,
                     false);
  if (!key) shown_ = predictor_.stencils().fresh();
  const Pieces& pieces = predictor_.pieces();
  const bool rans = header_.coder_id == kCoderContextRans;
  CLEAVE_ASSIGN_OR_RETURN(
      const FrameMotion motion,
      ReadMotion(key, header_, sections[0], pieces.count(), predictor_.order().groups()));

  std::optional<ResidualCoder> coder;
  if (rans) {
    coder.emplace(state.residuals, key, ResidualCoder::Direction::kDecode);
    BeginResiduals(key, predictor_.order(), motion, state.residuals, next.residuals);
  }
  std::vector<SymbolCounts> counts(rans ? chunks : 0);
  std::vector<absl::Status> statuses(chunks);
  ParallelFor(static_cast<int64_t>(chunks), 1, [&](int64_t from, int64_t to) {
    std::vector<int32_t> some;
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
      std::span<const int32_t> moving =
          predictor_.PlacesWithin(static_cast<int64_t>(first), static_cast<int64_t>(count));
      if (!motion.held.empty()) {
        some.clear();
        for (const int32_t place : moving) {
          if (!motion.Holds(pieces[place])) some.push_back(place);
        }
        moving = some;
      }
      if (!rans) {
        statuses[index] = DecodePlanes(chunk, moving);
      } else if (chunk.raw_bytes == 0 && chunk.coded.empty()) {
        ResidualCoder::SkipZeros(moving, next.residuals.activities, counts[index]);
        for (const int32_t place : moving) residuals_[static_cast<size_t>(place)] = Int32x4{};
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
  const auto choose = [&](int64_t group) {
    return motion.continuations[static_cast<size_t>(group)];
  };
  const auto holds = [&](int32_t place) { return motion.Holds(pieces[place]); };
  const auto corrected = [&](int32_t place, Double4 prediction, double units) {
    const Double4 position = prediction + units * Widen(residuals_[static_cast<size_t>(place)]);
    if (Any(Abs(position) > kMaxQuantised)) {
      all_fit.store(false, std::memory_order_relaxed);
      return Double4{};
    }
    return position;
  };
  const auto run = [&](const auto& correct) {
    predictor_.Run(key, state.positions, state.previous, next.positions, choose, holds, correct);
  };
  if (motion.coarse.empty()) {
    run([&](int32_t place, Double4 prediction) {
      return corrected(place, prediction, kUnitsPerStep);
    });
  } else {
    run([&](int32_t place, Double4 prediction) {
      return corrected(place, prediction, kUnitsPerStep << motion.ShiftOf(pieces[place]));
    });
  }
  if (header_.has_regions()) {
    next.shifts.resize(nodes);
    for (size_t place = 0; place < nodes; ++place) {
      next.shifts[place] =
          static_cast<uint8_t>(motion.ShiftOf(pieces[static_cast<int32_t>(place)]));
    }
  }
  return all_fit.load() ? absl::OkStatus()
                        : absl::DataLossError("a decoded coordinate is out of range");
}

void InterpolationDecoder::Reject(StreamState& state) {
  // Elsewhere the next Decode brings everything to its own frame.
  if (!header_.is_surface() || state.frame < 0) return;
  for (const int32_t place : shown_) {
    for (std::vector<int32_t>* positions : {&state.positions, &state.previous}) {
      std::fill_n(positions->begin() + 3 * static_cast<std::ptrdiff_t>(place), 3, 0);
    }
  }
  shown_.clear();
  predictor_.Return(state.tolerance, state.broken_edges, state.positions, state.previous);
}

void InterpolationDecoder::Accept(FrameKind kind) {
  if (kind == FrameKind::kHold) {
    predictor_.Hold();
  } else {
    predictor_.Accept(kind == FrameKind::kKey);
  }
}

}  // namespace cleave
