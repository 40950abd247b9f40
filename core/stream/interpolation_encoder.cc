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
#include "core/stream/to_grid.h"

namespace cleave {
namespace {

constexpr int64_t kGrainNodes = 4096;
constexpr size_t kMaxSamples = 96;  // places a group that a continuation is fitted to

}  // namespace

InterpolationEncoder::InterpolationEncoder(const StreamHeader& header, const StreamMesh& mesh)
    : header_(header), predictor_(header, mesh) {
  targets_.resize(mesh.rest_positions.size());
  residuals_.resize(mesh.rest_positions.size());
  samples_.reserve(2 * kMaxSamples);
}

void InterpolationEncoder::SetRegion(const Region& region, int32_t shift) {
  const std::vector<int32_t> places = predictor_.order().PlacesOfNodes();
  region_ = PlacedRegion{.places = {}, .box = region.box, .shift = static_cast<uint8_t>(shift)};
  for (const int32_t node : region.nodes) {
    region_->places.push_back(places[static_cast<size_t>(node)]);
  }
}

// Targets leave room for the rounding to a residual.
double InterpolationEncoder::LargestTarget() const {
  return kMaxQuantised - (kUnitsPerStep << (region_.has_value() ? region_->shift : 0));
}

// Which pieces are outside of the region.
void InterpolationEncoder::ChooseCoarse() {
  motion_.coarse.clear();
  if (!region_.has_value() || region_->shift == 0) return;
  const Pieces& pieces = predictor_.pieces();
  motion_.shift = region_->shift;
  motion_.coarse.assign(static_cast<size_t>(pieces.count()), 1);
  const auto include = [&](int32_t place) {
    motion_.coarse[static_cast<size_t>(pieces[place])] = 0;
  };
  for (const int32_t place : region_->places) include(place);
  if (region_->box.has_value()) {
    const double inverse_unit = 1.0 / header_.UnitOf(tolerance_);
    std::array<Double4, 2> box{};
    for (size_t corner = 0; corner < 2; ++corner) {
      for (size_t axis = 0; axis < 3; ++axis) {
        box[corner][static_cast<int>(axis)] =
            ((*region_->box)[corner][axis] - header_.origin[axis]) * inverse_unit;
      }
    }
    for (size_t place = 0; place < targets_.size(); ++place) {
      const Double4 target = targets_[place];
      if (!Any(target < box[0]) && !Any(target > box[1])) include(static_cast<int32_t>(place));
    }
  }
  if (std::find(motion_.coarse.begin(), motion_.coarse.end(), 1) == motion_.coarse.end()) {
    motion_.coarse.clear();
  }
}

int32_t InterpolationEncoder::ShiftOf(size_t place) const {
  return motion_.coarse.empty() ? 0 : motion_.ShiftOf(predictor_.pieces().labels()[place]);
}

bool InterpolationEncoder::ShiftsAre(const std::vector<uint8_t>& shifts) const {
  for (size_t place = 0; place < targets_.size(); ++place) {
    if (shifts[place] != ShiftOf(place)) return false;
  }
  return true;
}

void InterpolationEncoder::GetShifts(std::vector<uint8_t>& shifts) const {
  shifts.resize(targets_.size());
  for (size_t place = 0; place < targets_.size(); ++place) {
    shifts[place] = static_cast<uint8_t>(ShiftOf(place));
  }
}

absl::Status InterpolationEncoder::SetTargets(const std::vector<Vec3>& positions,
                                              double tolerance) {
  const double inverse_unit = 1.0 / header_.UnitOf(tolerance);
  const double largest = LargestTarget();
  const Vec3 origin = header_.origin;
  const ToGrid to_grid(positions, origin, inverse_unit);
  const std::vector<int32_t>& nodes = predictor_.order().nodes;
  const bool is_surface = header_.is_surface();
  std::atomic<bool> all_fit{true};
  ParallelFor(static_cast<int64_t>(nodes.size()), kGrainNodes, [&](int64_t begin, int64_t end) {
    Int64x4 fits = ~Int64x4{};
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const Double4 target = to_grid(is_surface ? at : static_cast<size_t>(nodes[at]));
      fits &= (target <= largest) & (target >= -largest);
      if (!is_surface) targets_[at] = target;
    }
    const bool fit = !Any(~fits);
    if (!fit) all_fit.store(false, std::memory_order_relaxed);
  });
  if (!all_fit.load()) {
    for (size_t node = 0; node < positions.size(); ++node) {
      const Vec3& x = positions[node];
      bool fit = true;
      for (size_t axis = 0; axis < 3; ++axis) {
        fit &= std::abs((x[axis] - origin[axis]) * inverse_unit) <= largest;
      }
      if (fit) continue;
      return absl::OutOfRangeError(
          absl::StrCat("POSITION_OUT_OF_RANGE: node ", node, " at (", x[0], ", ", x[1], ", ", x[2],
                       ") m is not finite or farther than ", largest / inverse_unit, " m from (",
                       origin[0], ", ", origin[1], ", ", origin[2],
                       "), which is what a tolerance of ", tolerance, " m can reach"));
    }
  }
  tolerance_ = tolerance;
  return absl::OkStatus();
}

bool InterpolationEncoder::Stays(const StreamState& state, size_t place, int32_t shift) const {
  const int32_t* last = state.positions.data() + 3 * place;
  const Double4 from = {static_cast<double>(last[0]), static_cast<double>(last[1]),
                        static_cast<double>(last[2]), 0};
  return !Any(Abs(targets_[place] - from) > (kUnitsPerStep << shift) / 2);
}

bool InterpolationEncoder::AllHold(const StreamState& state) {
  ChooseCoarse();
  // A hold has no motion to say what is coarse.
  if (header_.has_regions() && !ShiftsAre(state.shifts)) return false;
  for (size_t place = 0; place < targets_.size(); ++place) {
    if (!Stays(state, place, ShiftOf(place))) return false;
  }
  return true;
}

void InterpolationEncoder::ChooseHolds(const StreamState& state) {
  const Pieces& pieces = predictor_.pieces();
  motion_.held.assign(static_cast<size_t>(pieces.count()), 1);
  int32_t left = pieces.count();
  for (size_t place = 0; place < targets_.size() && left > 0; ++place) {
    const int32_t piece = pieces.labels()[place];
    uint8_t& held = motion_.held[static_cast<size_t>(piece)];
    if (held == 0 || Stays(state, place, motion_.ShiftOf(piece))) continue;
    held = 0;
    --left;
  }
  if (left == 0) motion_.held.clear();
}

Continuation InterpolationEncoder::Choose(int64_t group) {
  const NodeOrder& order = predictor_.order();
  const int32_t begin = order.group_begins[static_cast<size_t>(group)];
  const int32_t end = order.group_begins[static_cast<size_t>(group) + 1];
  const std::span<const int32_t> places = predictor_.PlacesWithin(begin, end - begin);
  const size_t stride = std::max<size_t>(1, places.size() / kMaxSamples);
  samples_.clear();
  for (size_t at = stride / 2; at < places.size(); at += stride) {
    const int32_t place = places[at];
    if (predictor_.stencils()[place].leads() || motion_.Holds(predictor_.pieces()[place])) continue;
    samples_.push_back({targets_[static_cast<size_t>(place)] - predictor_.Blend(place),
                        Widen(predictor_.LastDetail(place)), Widen(predictor_.DetailBefore(place)),
                        Widen(predictor_.RestDetail(place))});
  }
  return FitContinuation(samples_);
}

void InterpolationEncoder::SetBroken(bool key, std::span<const int32_t> broken,
                                     std::span<const Vec3> positions, StreamState& state) {
  if (header_.is_surface() && history_is_new_ && state.frame >= 0) {
    // What comes into view now does so after what the state has in view.
    predictor_.Return(state.tolerance, state.broken_edges, state.positions, state.previous);
    history_is_new_ = false;
  }
  predictor_.Prepare(key, tolerance_, broken, state.positions, state.previous, history_is_new_);
  history_is_new_ = false;
  if (!header_.is_surface()) return;
  // Hidden places are at 0 in every state, and so they stay there. Only from a key frame on may
  // some be hidden that were not.
  if (key) std::fill(targets_.begin(), targets_.end(), Double4{});
  const std::vector<int32_t>& places = predictor_.places();
  const std::vector<int32_t>& nodes = predictor_.order().nodes;
  const ToGrid to_grid(positions, header_.origin, 1.0 / header_.UnitOf(tolerance_));
  ParallelFor(static_cast<int64_t>(places.size()), kGrainNodes, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const auto place = static_cast<size_t>(places[at]);
      targets_[place] = to_grid(static_cast<size_t>(nodes[place]));
    }
  });
}

void InterpolationEncoder::Encode(bool key, const StreamState& state, FrameHeader& header,
                                  std::string& body, std::vector<int32_t>& next,
                                  ResidualHistory& next_history) {
  motion_.held.clear();
  ChooseCoarse();
  if (!key) ChooseHolds(state);
  motion_.continuations.clear();
  next.resize(3 * targets_.size());
  const auto choose = [&](int64_t group) {
    motion_.continuations.push_back(key ? kFromRest : Choose(group));
    return motion_.continuations.back();
  };
  const auto holds = [&](int32_t place) { return motion_.Holds(predictor_.pieces()[place]); };
  const auto corrected = [&](int32_t place, Double4 prediction, double units) {
    const Double4 steps =
        Floor((targets_[static_cast<size_t>(place)] - prediction) * (1.0 / units) + 0.5);
    residuals_[static_cast<size_t>(place)] = ToInts(steps);
    return prediction + units * steps;
  };
  const auto run = [&](const auto& correct) {
    predictor_.Run(key, state.positions, state.previous, next, choose, holds, correct);
  };
  if (motion_.coarse.empty()) {
    run([&](int32_t place, Double4 prediction) {
      return corrected(place, prediction, kUnitsPerStep);
    });
  } else {
    run([&](int32_t place, Double4 prediction) {
      const int32_t shift = motion_.ShiftOf(predictor_.pieces()[place]);
      return corrected(place, prediction, kUnitsPerStep << shift);
    });
  }
  motion_.classes.clear();
  std::optional<ResidualCoder> coder;
  if (header_.coder_id == kCoderContextRans) {
    coder.emplace(state.residuals, key, ResidualCoder::Direction::kEncode);
    motion_.classes = class_choice_.Choose(key, predictor_, motion_, residuals_,
                                           state.residuals.activities, *coder);
    BeginResiduals(key, predictor_.order(), motion_, state.residuals, next_history);
  }
  AppendMotion(key, motion_, predictor_.order().groups(), header, body);
  AppendPositions(coder.has_value() ? &*coder : nullptr, header, body, next_history);
}

void InterpolationEncoder::AppendPositions(const ResidualCoder* coder, FrameHeader& header,
                                           std::string& body, ResidualHistory& next) {
  const auto nodes = static_cast<int64_t>(header_.node_count);
  const auto chunk_nodes = static_cast<int64_t>(header_.chunk_nodes);
  const int64_t chunks = (nodes + chunk_nodes - 1) / chunk_nodes;
  chunks_.resize(static_cast<size_t>(chunks));
  ParallelFor(chunks, 1, [&](int64_t from, int64_t to) {
    for (int64_t index = from; index < to; ++index) {
      Chunk& chunk = chunks_[static_cast<size_t>(index)];
      PositionChunk& section = chunk.section;
      section.prediction = Prediction::kInterpolation;
      section.raw_bytes = 0;
      section.coded.clear();
      const int64_t first = index * chunk_nodes;
      std::span<const int32_t> moving =
          predictor_.PlacesWithin(first, std::min(chunk_nodes, nodes - first));
      if (!motion_.held.empty()) {
        chunk.moving.clear();
        for (const int32_t place : moving) {
          if (!motion_.Holds(predictor_.pieces()[place])) chunk.moving.push_back(place);
        }
        moving = chunk.moving;
      }
      if (coder == nullptr) {
        std::vector<int32_t> values;
        values.reserve(3 * moving.size());
        for (const int32_t place : moving) {
          const Int32x4 r = residuals_[static_cast<size_t>(place)];
          for (int axis = 0; axis < 3; ++axis) values.push_back(r[axis]);
        }
        const std::string planes = ToBytePlanes(values);
        section.raw_bytes = static_cast<uint32_t>(planes.size());
        if (!planes.empty()) {
          section.coded = CodeParts(planes, static_cast<uint32_t>(planes.size() / values.size()));
        }
      } else {
        chunk.counts = {};
        section.coded =
            coder->Encode(moving, residuals_, next.activities, chunk.counts, chunk.writer);
        if (!section.coded.empty()) section.raw_bytes = static_cast<uint32_t>(12 * moving.size());
      }
    }
  });
  for (int64_t index = 0; index < chunks; ++index) {
    const Chunk& chunk = chunks_[static_cast<size_t>(index)];
    AppendPositionChunk(header_, index, chunk.section, header, body);
    if (coder != nullptr) next.counts.Add(chunk.counts);
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
