#include "core/stream/frame_decoder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/stream/exact_positions.h"
#include "core/stream/section_coder.h"

namespace cleave {

absl::StatusOr<FrameDecoder> FrameDecoder::Create(absl::string_view header_bytes,
                                                  const StreamMesh& mesh,
                                                  const DecoderLimits& limits) {
  FrameDecoder decoder;
  CLEAVE_ASSIGN_OR_RETURN(decoder.header_, ParseStreamHeader(header_bytes));
  const StreamHeader& header = decoder.header_;
  if (header.node_count > limits.max_nodes || header.edge_count > limits.max_edges) {
    return absl::ResourceExhaustedError(
        absl::StrCat("stream of ", header.node_count, " nodes and ", header.edge_count,
                     " edges is above the limit of ", limits.max_nodes, " and ", limits.max_edges));
  }
  CLEAVE_RETURN_IF_ERROR(CheckStreamMesh(header, mesh));
  decoder.header_bytes_ = std::string(header_bytes);
  if (header.predictor_id == kPredictorInterpolation) {
    decoder.interpolation_.emplace(header, mesh);
    decoder.labels_.emplace(decoder.interpolation_->order(), decoder.interpolation_->stencils(),
                            mesh.edges);
  } else if (decoder.exact()) {
    CLEAVE_RETURN_IF_ERROR(RankPositions(mesh.rest_positions, decoder.exact_rest_));
  } else {
    decoder.rest_positions_.assign(mesh.rest_positions.begin(), mesh.rest_positions.end());
  }
  decoder.frame_.frame = -1;
  return decoder;
}

absl::Status FrameDecoder::CheckBase(const FrameHeader& frame) const {
  if (frame.broken_edges > header_.edge_count) {
    return absl::DataLossError(absl::StrCat("frame has ", frame.broken_edges,
                                            " broken edges; the mesh has ", header_.edge_count));
  }
  if (frame.kind == FrameKind::kKey) {
    if (const absl::Status status = CheckTolerance(frame.tolerance, header_); !status.ok()) {
      return absl::DataLossError(status.message());
    }
    return absl::OkStatus();
  }
  if (state_.frame < 0 || frame.epoch != state_.epoch || frame.base_frame != state_.frame) {
    return absl::FailedPreconditionError(absl::StrCat(
        "frame ", frame.frame, " of epoch ", frame.epoch, " applies to frame ", frame.base_frame,
        "; the decoder is at frame ", state_.frame, " of epoch ", state_.epoch));
  }
  if (frame.tolerance != state_.tolerance) {
    return absl::FailedPreconditionError(absl::StrCat("frame ", frame.frame, " has a tolerance of ",
                                                      frame.tolerance, " m; the decoder is at ",
                                                      state_.tolerance, " m"));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<int32_t>> FrameDecoder::DecodeLabels(const Section& section) const {
  if (section.coder != kCoderContextRans || section.first != 0 ||
      section.prediction != Prediction::kNone || section.count != header_.node_count ||
      section.raw_bytes != section.count) {
    return absl::DataLossError("topology labels do not fit their frame");
  }
  return labels_->Decode(section.coded);
}

absl::Status FrameDecoder::DecodeTopology(const FrameParts& parts, StreamState& next,
                                          size_t& section) const {
  const bool key = parts.header.kind == FrameKind::kKey;
  const SectionType expected = key ? SectionType::kTopologyCheckpoint : SectionType::kTopologyDelta;
  const size_t before = key ? 0 : state_.broken_edges.size();
  std::vector<int32_t> between;
  if (key && labels_.has_value() && !parts.sections.empty() &&
      parts.sections[0].type == SectionType::kTopologyLabels) {
    CLEAVE_ASSIGN_OR_RETURN(between, DecodeLabels(parts.sections[0]));
    ++section;
  }
  std::vector<int32_t> listed;
  std::string raw;
  for (; section < parts.sections.size() && parts.sections[section].type == expected; ++section) {
    const Section& part = parts.sections[section];
    if (part.coder != kCoderZstdPlanes) {
      return absl::UnimplementedError(absl::StrCat("section coder ", part.coder, " is not known"));
    }
    if (part.first != 0 || part.prediction != Prediction::kNone || part.count == 0 ||
        part.count > kMaxTopologyEdges || part.raw_bytes < part.count ||
        part.raw_bytes > 5 * part.count ||
        before + listed.size() + part.count > parts.header.broken_edges) {
      return absl::DataLossError("topology section does not fit its frame");
    }
    raw.resize(part.raw_bytes);
    CLEAVE_RETURN_IF_ERROR(DecodeParts(part.coded, 1, raw));
    const int64_t first = listed.empty() ? 0 : int64_t{listed.back()} + 1;
    CLEAVE_RETURN_IF_ERROR(
        FromGaps(raw, part.count, first, static_cast<int64_t>(header_.edge_count), listed));
  }
  next.broken_edges.clear();
  const std::vector<int32_t>& others = key ? between : state_.broken_edges;
  std::set_union(others.begin(), others.end(), listed.begin(), listed.end(),
                 std::back_inserter(next.broken_edges));
  // An edge that breaks a second time makes the union too small.
  if (next.broken_edges.size() != parts.header.broken_edges) {
    return absl::DataLossError(absl::StrCat("frame declares ", parts.header.broken_edges,
                                            " broken edges and lists ", next.broken_edges.size()));
  }
  return absl::OkStatus();
}

absl::Status FrameDecoder::Apply(absl::string_view frame_bytes) {
  CLEAVE_ASSIGN_OR_RETURN(const FrameParts parts, SplitFrame(frame_bytes));
  const FrameHeader& frame = parts.header;
  CLEAVE_RETURN_IF_ERROR(CheckBase(frame));
  if (frame.kind == FrameKind::kKey && !interpolation_.has_value() && !exact() &&
      rest_tolerance_ != frame.tolerance) {
    rest_ = QuantiseRest(rest_positions_, header_.origin,
                         QuantisationStep(frame.tolerance, header_.domain_bound));
    rest_tolerance_ = frame.tolerance;
  }
  StreamState& next = scratch_;
  next.frame = frame.frame;
  next.epoch = frame.epoch;
  next.time = frame.time;
  next.tolerance = frame.tolerance;
  next.fragments = frame.fragments;
  size_t section = 0;
  CLEAVE_RETURN_IF_ERROR(DecodeTopology(parts, next, section));
  absl::Status decoded;
  if (frame.kind == FrameKind::kHold) {
    if (!parts.sections.empty()) return absl::DataLossError("a hold frame has sections");
    next.positions = state_.positions;
    next.exact = state_.exact;
    next.shifts = state_.shifts;
    next.residuals = state_.residuals;
  } else if (interpolation_.has_value()) {
    decoded =
        interpolation_->Decode(frame, std::span(parts.sections).subspan(section), state_, next);
  } else {
    CLEAVE_RETURN_IF_ERROR(DecodePositions(parts, section, next));
  }
  if (decoded.ok() && HashStreamState(header_bytes_, next) != frame.state_hash) {
    decoded = absl::DataLossError(absl::StrCat("frame ", frame.frame, " fails its state hash"));
  }
  if (!decoded.ok()) {
    if (interpolation_.has_value() && frame.kind != FrameKind::kHold)
      interpolation_->Reject(state_);
    return decoded;
  }
  Accept(next, frame);
  return absl::OkStatus();
}

std::vector<double> FrameDecoder::Tolerances() const {
  std::vector<double> tolerances(header_.node_count, state_.tolerance);
  for (size_t place = 0; place < state_.shifts.size(); ++place) {
    const auto node = static_cast<size_t>(interpolation_->order().nodes[place]);
    tolerances[node] = std::ldexp(state_.tolerance, state_.shifts[place]);
  }
  return tolerances;
}

void FrameDecoder::Accept(StreamState& next, const FrameHeader& frame) {
  next.has_previous = frame.kind != FrameKind::kKey;
  std::swap(state_, next);
  // The state before is now `next`; its positions become the history.
  state_.previous.swap(next.positions);
  state_.previous_exact.swap(next.exact);
  state_hash_ = frame.state_hash;
  if (interpolation_.has_value()) {
    interpolation_->Accept(frame.kind);
    state_.has_previous = true;
    if (frame.kind == FrameKind::kKey) state_.previous = state_.positions;
  }

  frame_.frame = state_.frame;
  frame_.time = state_.time;
  frame_.fragments = state_.fragments;
  frame_.broken_edges = state_.broken_edges;
  frame_.positions.resize(header_.node_count);
  if (exact()) {
    for (size_t node = 0; node < frame_.positions.size(); ++node) {
      for (size_t axis = 0; axis < 3; ++axis) {
        frame_.positions[node][axis] = OfRank(state_.exact[3 * node + axis]);
      }
    }
    return;
  }
  if (header_.is_surface()) {
    ShowVisible();
    return;
  }
  const double unit = header_.UnitOf(state_.tolerance);
  const Vec3 origin = header_.origin;
  const int32_t* nodes =
      interpolation_.has_value() ? interpolation_->order().nodes.data() : nullptr;
  ParallelFor(static_cast<int64_t>(header_.node_count), 4096, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const size_t node = nodes == nullptr ? at : static_cast<size_t>(nodes[at]);
      for (size_t axis = 0; axis < 3; ++axis) {
        frame_.positions[node][axis] =
            origin[axis] + static_cast<double>(state_.positions[3 * at + axis]) * unit;
      }
    }
  });
}

// Hidden nodes are where the first visible one of their piece is.
void FrameDecoder::ShowVisible() {
  const Stencils& stencils = interpolation_->stencils();
  const std::vector<int32_t>& nodes = interpolation_->order().nodes;
  const double unit = header_.UnitOf(state_.tolerance);
  const Vec3 origin = header_.origin;
  frame_.visible.resize(nodes.size());
  ParallelFor(static_cast<int64_t>(nodes.size()), 4096, [&](int64_t begin, int64_t end) {
    for (auto place = static_cast<int32_t>(begin); place < end; ++place) {
      const auto node = static_cast<size_t>(nodes[static_cast<size_t>(place)]);
      const bool is_visible = stencils.visible()->Has(place);
      const int32_t leader = is_visible ? place : stencils.LeaderOf(stencils.pieces()[place]);
      const auto at = static_cast<size_t>(leader >= 0 ? leader : place);
      frame_.visible[node] = is_visible ? 1 : 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        frame_.positions[node][axis] =
            origin[axis] + static_cast<double>(state_.positions[3 * at + axis]) * unit;
      }
    }
  });
}

}  // namespace cleave
