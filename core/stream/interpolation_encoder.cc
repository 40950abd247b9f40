#include "core/stream/interpolation_encoder.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"
#include "core/stream/continuation_fit.h"
#include "core/stream/residual_coder.h"
#include "core/stream/section_coder.h"

namespace cleave {
namespace {

constexpr int64_t kGrainNodes = 4096;
constexpr int32_t kMaxSamples = 96;  // places a group that a continuation is fitted to

// Targets leave room for the rounding to a residual.
constexpr double kMaxTarget = kMaxQuantised - kUnitsPerStep;

}  // namespace

InterpolationEncoder::InterpolationEncoder(const StreamHeader& header, const StreamMesh& mesh)
    : header_(header), predictor_(header, mesh) {
  targets_.resize(3 * mesh.rest_positions.size());
  residuals_.resize(3 * mesh.rest_positions.size());
  moves_.resize(mesh.rest_positions.size());
}

absl::Status InterpolationEncoder::SetTargets(const std::vector<Vec3>& positions,
                                              double tolerance) {
  const double inverse_unit = 1.0 / header_.UnitOf(tolerance);
  const Vec3 origin = header_.origin;
  const std::vector<int32_t>& nodes = predictor_.order().nodes;
  std::atomic<bool> all_fit{true};
  ParallelFor(static_cast<int64_t>(nodes.size()), kGrainNodes, [&](int64_t begin, int64_t end) {
    bool fit = true;
    for (auto place = static_cast<size_t>(begin); place < static_cast<size_t>(end); ++place) {
      const Vec3& position = positions[static_cast<size_t>(nodes[place])];
      for (size_t axis = 0; axis < 3; ++axis) {
        const double target = (position[axis] - origin[axis]) * inverse_unit;
        fit &= target >= -kMaxTarget && target <= kMaxTarget;
        targets_[3 * place + axis] = target;
      }
    }
    if (!fit) all_fit.store(false, std::memory_order_relaxed);
  });
  if (!all_fit.load()) {
    for (size_t node = 0; node < positions.size(); ++node) {
      const Vec3& x = positions[node];
      bool fit = true;
      for (size_t axis = 0; axis < 3; ++axis) {
        fit &= std::abs((x[axis] - origin[axis]) * inverse_unit) <= kMaxTarget;
      }
      if (fit) continue;
      return absl::OutOfRangeError(
          absl::StrCat("POSITION_OUT_OF_RANGE: node ", node, " at (", x[0], ", ", x[1], ", ", x[2],
                       ") m is not finite or farther than ", kMaxTarget / inverse_unit, " m from (",
                       origin[0], ", ", origin[1], ", ", origin[2],
                       "), which is what a tolerance of ", tolerance, " m can reach"));
    }
  }
  tolerance_ = tolerance;
  return absl::OkStatus();
}

bool InterpolationEncoder::Stays(const StreamState& state, size_t place) const {
  constexpr double kHalfStep = kUnitsPerStep / 2;
  bool stays = true;
  for (size_t at = 3 * place; at < 3 * place + 3; ++at) {
    stays &= std::abs(targets_[at] - state.positions[at]) <= kHalfStep;
  }
  return stays;
}

bool InterpolationEncoder::AllHold(const StreamState& state) const {
  for (size_t place = 0; place < moves_.size(); ++place) {
    if (!Stays(state, place)) return false;
  }
  return true;
}

void InterpolationEncoder::ChooseHolds(const StreamState& state) {
  ParallelFor(static_cast<int64_t>(moves_.size()), kGrainNodes, [&](int64_t begin, int64_t end) {
    for (auto place = static_cast<size_t>(begin); place < static_cast<size_t>(end); ++place) {
      moves_[place] = Stays(state, place) ? 0 : 1;
    }
  });
  const Pieces& pieces = predictor_.pieces();
  motion_.held.assign(static_cast<size_t>(pieces.count()), true);
  for (size_t place = 0; place < moves_.size(); ++place) {
    if (moves_[place] != 0) motion_.held[static_cast<size_t>(pieces.labels()[place])] = false;
  }
  if (std::find(motion_.held.begin(), motion_.held.end(), true) == motion_.held.end()) {
    motion_.held.clear();
  }
}

Continuation InterpolationEncoder::Choose(int64_t group, std::span<const int32_t> next) {
  const NodeOrder& order = predictor_.order();
  const int32_t begin = order.group_begins[static_cast<size_t>(group)];
  const int32_t end = order.group_begins[static_cast<size_t>(group) + 1];
  const int32_t stride = std::max(1, (end - begin) / kMaxSamples);
  std::vector<DetailSample> samples;
  for (int32_t place = begin + stride / 2; place < end; place += stride) {
    if (predictor_.stencils()[place].leads() || motion_.Holds(predictor_.pieces()[place])) continue;
    const Grid3 blend = predictor_.Blend(place, next);
    DetailSample sample;
    sample.details = predictor_.details(place);
    for (size_t axis = 0; axis < 3; ++axis) {
      sample.wanted[axis] = targets_[3 * static_cast<size_t>(place) + axis] - blend[axis];
    }
    samples.push_back(sample);
  }
  return FitContinuation(samples);
}

void InterpolationEncoder::SetBroken(std::span<const int32_t> broken, const StreamState& state) {
  predictor_.Prepare(tolerance_, broken, state.positions, state.previous, history_is_new_);
  history_is_new_ = false;
}

void InterpolationEncoder::Encode(bool key, const StreamState& state, FrameHeader& header,
                                  std::string& body, std::vector<int32_t>& next,
                                  ResidualHistory& next_history) {
  motion_.held.clear();
  if (!key) ChooseHolds(state);
  motion_.continuations.clear();
  next.resize(targets_.size());
  const auto choose = [&](int64_t group, std::span<const int32_t> done) {
    motion_.continuations.push_back(key ? kFromRest : Choose(group, done));
    return motion_.continuations.back();
  };
  const auto correct = [&](int32_t place, const Grid3& prediction) {
    const bool holds = motion_.Holds(predictor_.pieces()[place]);
    Grid3 position{};
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t at = 3 * static_cast<size_t>(place) + axis;
      const double steps =
          std::floor((targets_[at] - prediction[axis]) * (1.0 / kUnitsPerStep) + 0.5);
      residuals_[at] = holds ? 0 : static_cast<int32_t>(steps);
      position[axis] =
          holds ? state.positions[at]
                : static_cast<int32_t>(prediction[axis] + int64_t{kUnitsPerStep} * residuals_[at]);
    }
    return position;
  };
  predictor_.Run(key, state.positions, state.previous, next, choose, correct);
  const bool fresh = key || state.residuals.fresh;
  motion_.classes.clear();
  if (fresh && header_.coder_id == kCoderContextRans) ChooseClasses();
  AppendMotion(key, motion_, predictor_.order().groups(), header, body);
  AppendPositions(fresh, state.residuals, header, body, next_history);
  next_history.fresh = key;
}

void InterpolationEncoder::ChooseClasses() {
  const NodeOrder& order = predictor_.order();
  for (size_t group = 0; group + 1 < order.group_begins.size(); ++group) {
    uint64_t sum = 0;
    uint64_t moving = 1;
    for (int32_t place = order.group_begins[group]; place < order.group_begins[group + 1];
         ++place) {
      if (motion_.Holds(predictor_.pieces()[place])) continue;
      ++moving;
      for (size_t axis = 0; axis < 3; ++axis) {
        sum += static_cast<uint64_t>(std::abs(residuals_[3 * static_cast<size_t>(place) + axis]));
      }
    }
    motion_.classes.push_back(
        ClassOf(static_cast<uint32_t>(std::min<uint64_t>(16 * sum / moving, 65535))));
  }
}

void InterpolationEncoder::AppendPositions(bool fresh, const ResidualHistory& history,
                                           FrameHeader& header, std::string& body,
                                           ResidualHistory& next) const {
  const bool rans = header_.coder_id == kCoderContextRans;
  std::optional<ResidualCoder> coder;
  if (rans) {
    coder.emplace(history, fresh, ResidualCoder::Direction::kEncode);
    BeginResiduals(predictor_.order(), motion_, history, next);
  }
  const auto nodes = static_cast<int64_t>(header_.node_count);
  const auto chunk_nodes = static_cast<int64_t>(header_.chunk_nodes);
  const int64_t chunks = (nodes + chunk_nodes - 1) / chunk_nodes;
  struct Chunk {
    uint32_t raw_bytes = 0;
    std::string coded;
    SymbolCounts counts;
  };
  std::vector<Chunk> coded(static_cast<size_t>(chunks));
  ParallelFor(chunks, 1, [&](int64_t from, int64_t to) {
    std::vector<int32_t> moving;
    RansWriter writer;
    for (int64_t index = from; index < to; ++index) {
      Chunk& chunk = coded[static_cast<size_t>(index)];
      moving.clear();
      bool all_zero = true;
      const int64_t end = std::min(nodes, (index + 1) * chunk_nodes);
      for (auto place = static_cast<int32_t>(index * chunk_nodes); place < end; ++place) {
        if (motion_.Holds(predictor_.pieces()[place])) continue;
        moving.push_back(place);
        const int32_t* r = residuals_.data() + 3 * static_cast<size_t>(place);
        all_zero &= (r[0] | r[1] | r[2]) == 0;
      }
      if (!rans) {
        std::vector<int32_t> values;
        values.reserve(3 * moving.size());
        for (const int32_t place : moving) {
          const auto r = residuals_.begin() + 3 * place;
          values.insert(values.end(), r, r + 3);
        }
        const std::string planes = ToBytePlanes(values);
        chunk.raw_bytes = static_cast<uint32_t>(planes.size());
        if (!planes.empty()) {
          chunk.coded = CodeParts(planes, static_cast<uint32_t>(planes.size() / values.size()));
        }
      } else if (all_zero) {
        ResidualCoder::SkipZeros(moving, next.activities, chunk.counts);
      } else {
        writer.Clear();
        coder->Encode(moving, residuals_, next.activities, chunk.counts, writer);
        chunk.raw_bytes = static_cast<uint32_t>(12 * moving.size());
        chunk.coded = writer.Finish();
      }
    }
  });
  for (int64_t index = 0; index < chunks; ++index) {
    const Chunk& chunk = coded[static_cast<size_t>(index)];
    const int64_t first = index * chunk_nodes;
    AppendSection({.type = SectionType::kPositions,
                   .coder = static_cast<uint8_t>(header_.coder_id),
                   .prediction = Prediction::kInterpolation,
                   .raw_bytes = chunk.raw_bytes,
                   .first = static_cast<uint32_t>(first),
                   .count = static_cast<uint32_t>(std::min(chunk_nodes, nodes - first)),
                   .coded = chunk.coded},
                  body);
    ++header.section_count;
    if (rans) next.counts.Add(chunk.counts);
  }
}

void InterpolationEncoder::Accept(FrameKind kind) {
  if (kind == FrameKind::kHold) {
    predictor_.Hold();
  } else {
    predictor_.Accept(kind == FrameKind::kKey);
  }
}

}  // namespace cleave
