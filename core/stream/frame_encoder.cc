#include "core/stream/frame_encoder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/run_both.h"
#include "core/base/status.h"
#include "core/stream/exact_positions.h"
#include "core/stream/section_coder.h"

namespace cleave {

absl::StatusOr<FrameEncoder> FrameEncoder::Create(const StreamHeader& header,
                                                  const StreamMesh& mesh,
                                                  std::optional<StreamState> state) {
  FrameEncoder encoder;
  encoder.header_bytes_ = SerializeStreamHeader(header);
  CLEAVE_ASSIGN_OR_RETURN(encoder.header_, ParseStreamHeader(encoder.header_bytes_));
  CLEAVE_RETURN_IF_ERROR(CheckStreamMesh(header, mesh));
  const std::span<const Vec3> rest_positions = mesh.rest_positions;
  encoder.tolerance_ = header.tolerance;
  const bool exact = encoder.exact();
  const size_t coordinates = 3 * rest_positions.size();
  if (exact) {
    CLEAVE_RETURN_IF_ERROR(RankPositions(rest_positions, encoder.exact_rest_));
  } else {
    encoder.next_.resize(coordinates);
  }
  if (state.has_value() && state->frame >= 0) {
    const size_t last = exact ? state->exact.size() : state->positions.size();
    const size_t previous = exact ? state->previous_exact.size() : state->previous.size();
    if (last != coordinates || (state->has_previous && previous != coordinates)) {
      return absl::FailedPreconditionError("the state to go on from is of another mesh");
    }
    CLEAVE_RETURN_IF_ERROR(CheckTolerance(state->tolerance, header));
    encoder.tolerance_ = state->tolerance;
    encoder.epoch_ = state->epoch;
    encoder.state_ = *std::move(state);
  }
  if (header.predictor_id == kPredictorInterpolation) {
    if (encoder.state_.frame >= 0 && !encoder.state_.has_previous) {
      return absl::FailedPreconditionError("the state to go on from is of another predictor");
    }
    const ResidualHistory& residuals = encoder.state_.residuals;
    if (header.coder_id == kCoderContextRans && encoder.state_.frame >= 0 &&
        residuals.activities.size() != rest_positions.size()) {
      return absl::FailedPreconditionError("the state to go on from is of another coder");
    }
    if (header.has_regions() && encoder.state_.frame >= 0 &&
        encoder.state_.shifts.size() != rest_positions.size()) {
      return absl::FailedPreconditionError(
          "the state to go on from is of a stream without regions");
    }
    encoder.interpolation_.emplace(header, mesh);
    encoder.labels_.emplace(encoder.interpolation_->order(), encoder.interpolation_->stencils(),
                            mesh.edges);
    return encoder;
  }
  if (exact) return encoder;
  encoder.rest_positions_.assign(rest_positions.begin(), rest_positions.end());
  encoder.rest_ = QuantiseRest(encoder.rest_positions_, header.origin,
                               QuantisationStep(encoder.tolerance_, header.domain_bound));
  return encoder;
}

absl::Status FrameEncoder::StartEpoch(uint32_t epoch) {
  if (epoch <= epoch_) {
    return absl::InvalidArgumentError(
        absl::StrCat("epoch ", epoch, " does not rise; the stream is in epoch ", epoch_));
  }
  epoch_ = epoch;
  return absl::OkStatus();
}

absl::Status FrameEncoder::SetTolerance(double tolerance) {
  CLEAVE_RETURN_IF_ERROR(CheckTolerance(tolerance, header_));
  tolerance_ = tolerance;
  PlaceRegion();
  if (interpolation_.has_value() || exact()) return absl::OkStatus();
  rest_ = QuantiseRest(rest_positions_, header_.origin,
                       QuantisationStep(tolerance_, header_.domain_bound));
  return absl::OkStatus();
}

absl::Status FrameEncoder::SetRegion(std::optional<Region> region) {
  if (region.has_value()) CLEAVE_RETURN_IF_ERROR(CheckRegion(*region, header_, tolerance_));
  region_ = std::move(region);
  PlaceRegion();
  return absl::OkStatus();
}

void FrameEncoder::PlaceRegion() {
  if (!interpolation_.has_value()) return;
  if (!region_.has_value()) {
    interpolation_->ClearRegion();
    return;
  }
  const int power = std::ilogb(region_->outside_tolerance / tolerance_);
  interpolation_->SetRegion(*region_, std::clamp(power, 0, kMaxShift));
}

absl::Status FrameEncoder::CheckFrame(const Frame& frame) const {
  if (frame.frame < 0 || (GoesOn() && frame.frame <= state_.frame)) {
    return absl::InvalidArgumentError(absl::StrCat("frame ", frame.frame, " does not follow frame ",
                                                   GoesOn() ? state_.frame : -1));
  }
  if (!std::isfinite(frame.time)) {
    return absl::InvalidArgumentError(absl::StrCat("time of ", frame.time, " s is not finite"));
  }
  if (frame.fragments < 0) {
    return absl::InvalidArgumentError(absl::StrCat("fragments is ", frame.fragments));
  }
  if (frame.positions.size() != header_.node_count) {
    return absl::InvalidArgumentError(absl::StrCat("frame has ", frame.positions.size(),
                                                   " positions; the mesh has ", header_.node_count,
                                                   " nodes"));
  }
  if (!frame.visible.empty()) {
    return absl::InvalidArgumentError("the positions of some nodes are not known");
  }
  return absl::OkStatus();
}

absl::Status FrameEncoder::CheckEdges(const std::vector<int32_t>& edges) const {
  if (GoesOn() && edges == state_.broken_edges) return absl::OkStatus();
  for (size_t at = 0; at < edges.size(); ++at) {
    if (edges[at] < 0 || static_cast<uint64_t>(edges[at]) >= header_.edge_count ||
        (at > 0 && edges[at] <= edges[at - 1])) {
      return absl::InvalidArgumentError(absl::StrCat("broken_edges[", at, "] is ", edges[at],
                                                     "; edges must ascend within [0, ",
                                                     header_.edge_count, ")"));
    }
  }
  if (GoesOn() && !std::includes(edges.begin(), edges.end(), state_.broken_edges.begin(),
                                 state_.broken_edges.end())) {
    return absl::InvalidArgumentError(
        "an edge that was broken is no longer; that needs a new epoch");
  }
  return absl::OkStatus();
}

absl::Status FrameEncoder::Quantise(const std::vector<Vec3>& positions) {
  if (interpolation_.has_value()) return interpolation_->SetTargets(positions, tolerance_);
  if (exact()) return RankPositions(positions, next_exact_);
  return QuantiseOnGrid(positions);
}

void FrameEncoder::AppendTopology(SectionType type, std::span<const int32_t> edges,
                                  FrameHeader& header, std::string& body) const {
  for (size_t begin = 0; begin < edges.size(); begin += kMaxTopologyEdges) {
    const auto piece =
        edges.subspan(begin, std::min<size_t>(kMaxTopologyEdges, edges.size() - begin));
    const std::string raw = ToGaps(piece);
    const std::string coded = CodeParts(raw, 1);
    AppendSection({.type = type,
                   .coder = kCoderZstdPlanes,
                   .raw_bytes = static_cast<uint32_t>(raw.size()),
                   .count = static_cast<uint32_t>(piece.size()),
                   .coded = coded},
                  body);
    ++header.section_count;
  }
}

// As labels and a list of what they do not say, or as a list, whichever is shorter.
void FrameEncoder::AppendCheckpoint(std::span<const int32_t> edges, FrameHeader& header,
                                    std::string& body) const {
  FrameHeader with_list = header;
  std::string list;
  AppendTopology(SectionType::kTopologyCheckpoint, edges, with_list, list);
  if (labels_.has_value() && !edges.empty()) {
    const std::vector<int32_t>& labels = interpolation_->pieces().labels();
    const std::string coded = labels_->Encode(labels);
    const std::vector<int32_t> said = labels_->Between(labels);
    std::vector<int32_t> unsaid;
    std::set_difference(edges.begin(), edges.end(), said.begin(), said.end(),
                        std::back_inserter(unsaid));
    FrameHeader with_labels = header;
    std::string labelled;
    AppendSection({.type = SectionType::kTopologyLabels,
                   .coder = kCoderContextRans,
                   .raw_bytes = static_cast<uint32_t>(header_.node_count),
                   .count = static_cast<uint32_t>(header_.node_count),
                   .coded = coded},
                  labelled);
    ++with_labels.section_count;
    AppendTopology(SectionType::kTopologyCheckpoint, unsaid, with_labels, labelled);
    if (labelled.size() < list.size()) {
      header.section_count = with_labels.section_count;
      body += labelled;
      return;
    }
  }
  header.section_count = with_list.section_count;
  body += list;
}

absl::StatusOr<EncodedFrame> FrameEncoder::Encode(const Frame& frame) {
  CLEAVE_RETURN_IF_ERROR(CheckFrame(frame));
  absl::Status edges, quantised;
  RunBoth([&] { edges = CheckEdges(frame.broken_edges); },
          [&] { quantised = Quantise(frame.positions); });
  CLEAVE_RETURN_IF_ERROR(edges);
  CLEAVE_RETURN_IF_ERROR(quantised);

  const bool key = state_.frame < 0 || epoch_ != state_.epoch || tolerance_ != state_.tolerance ||
                   frame.frame % header_.keyframe_interval == 0;
  const bool breaks = frame.broken_edges.size() != state_.broken_edges.size();
  EncodedFrame encoded;
  FrameHeader& header = encoded.header;
  header.frame = frame.frame;
  header.base_frame = key ? frame.frame : state_.frame;
  header.time = frame.time;
  header.tolerance = tolerance_;
  header.fragments = frame.fragments;
  header.broken_edges = frame.broken_edges.size();
  header.epoch = epoch_;
  std::string body;
  const auto append_positions = [&] {
    if (interpolation_.has_value()) {
      interpolation_->Encode(key, state_, header, body, next_, next_residuals_);
      std::swap(state_.residuals, next_residuals_);
      if (header_.has_regions()) interpolation_->GetShifts(state_.shifts);
    } else if (exact()) {
      AppendExactPositions(header_, key, exact_rest_, state_, next_exact_, header, body);
    } else {
      AppendPositions(key, header, body);
    }
  };
  const auto all_hold = [&] {
    if (interpolation_.has_value()) return interpolation_->AllHold(state_);
    return exact() ? next_exact_ == state_.exact : next_ == state_.positions;
  };
  const auto append_broken = [&] {
    std::vector<int32_t> newly_broken;
    std::set_difference(frame.broken_edges.begin(), frame.broken_edges.end(),
                        state_.broken_edges.begin(), state_.broken_edges.end(),
                        std::back_inserter(newly_broken));
    AppendTopology(SectionType::kTopologyDelta, newly_broken, header, body);
  };
  const auto set_broken = [&] {
    if (interpolation_.has_value()) {
      interpolation_->SetBroken(key, frame.broken_edges, frame.positions, state_);
    }
  };
  const bool lists = breaks && !key;
  // What holds depends on the pieces, or on what is in view.
  const bool ahead = header_.has_regions() || header_.is_surface();
  if (lists) {
    RunBoth(append_broken, set_broken);
  } else if (ahead) {
    set_broken();
  }
  const bool holds = !key && !breaks && all_hold();
  if (!lists && !ahead && !holds) set_broken();
  if (key) {
    header.kind = FrameKind::kKey;
    AppendCheckpoint(frame.broken_edges, header, body);
    append_positions();
  } else if (holds) {
    header.kind = FrameKind::kHold;
    next_ = state_.positions;
    next_exact_ = state_.exact;
  } else {
    header.kind = FrameKind::kDelta;
    append_positions();
  }

  state_.frame = frame.frame;
  state_.epoch = epoch_;
  state_.time = frame.time;
  state_.tolerance = tolerance_;
  state_.fragments = frame.fragments;
  if (breaks || key) state_.broken_edges = frame.broken_edges;
  state_.previous.swap(state_.positions);
  state_.positions.swap(next_);
  state_.previous_exact.swap(state_.exact);
  state_.exact.swap(next_exact_);
  state_.has_previous = !key;
  next_.resize(state_.positions.size());
  if (interpolation_.has_value()) {
    interpolation_->Accept(header.kind);
    state_.has_previous = true;
    if (key) state_.previous = state_.positions;
  }

  header.state_hash = HashStreamState(header_bytes_, state_);
  header.frame_bytes = kFrameHeaderBytes + body.size();
  encoded.bytes.reserve(header.frame_bytes);
  AppendFrameHeader(header, encoded.bytes);
  encoded.bytes += body;
  return encoded;
}

}  // namespace cleave
