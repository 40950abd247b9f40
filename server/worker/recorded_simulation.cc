#include "server/worker/recorded_simulation.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/mesh/incidence.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/stream_header.h"
#include "server/worker/event_message.h"

namespace cleave {

absl::StatusOr<std::unique_ptr<RecordedSimulation>> RecordedSimulation::Open(
    const SessionPaths& paths, SessionInputs inputs, int threads) {
  CLEAVE_ASSIGN_OR_RETURN(FrameLogWriter log, FrameLogWriter::Open(paths.frames()));
  CLEAVE_ASSIGN_OR_RETURN(Reports reports, Reports::Open(paths.reports(), log.head()));
  CLEAVE_ASSIGN_OR_RETURN(EventLogWriter events, EventLogWriter::Open(paths.events(), log.head()));
  std::unique_ptr<RecordedSimulation> recorded(new RecordedSimulation(
      Checkpoints(paths.checkpoints()), std::move(log), std::move(reports), std::move(events)));
  const Scene& scene = inputs.scene;
  StreamParameters parameters;
  parameters.mesh_sha256 = inputs.mesh_sha256;
  recorded->edges_ = BuildIncidence(inputs.mesh).edges;
  parameters.edge_count = recorded->edges_.size();
  parameters.tet_count = static_cast<uint64_t>(inputs.mesh.tet_count());
  parameters.tolerance = scene.output.tolerance.value_or(0);
  parameters.rung = inputs.rung.value_or(Rung::kStandard);
  parameters.keyframe_interval = static_cast<uint32_t>(scene.output.keyframe_interval);
  parameters.frames_per_second = scene.timing.frames_per_second;
  recorded->rest_positions_ = inputs.mesh.rest_positions;
  if (recorded->head() >= 0) {
    // A log goes on as it was begun, whatever this build would choose.
    CLEAVE_ASSIGN_OR_RETURN(const StreamHeader begun,
                            ParseStreamHeader(recorded->log_.header_bytes()));
    parameters.predictor_id = begun.predictor_id;
    parameters.coder_id = begun.coder_id;
  } else if (scene.output.tolerance == 0.0 || inputs.rung == Rung::kLossless) {
    ChooseExact(parameters);
  } else {
    ChooseIds(recorded->rest_positions_, parameters);
  }
  CLEAVE_ASSIGN_OR_RETURN(recorded->header_,
                          MakeStreamHeader(parameters, recorded->rest_positions_));
  if (recorded->head() < 0) recorded->whole_pieces_ = WholePiecesMessage(inputs.mesh);
  recorded->in_force_ = InForce(scene);
  recorded->checkpoint_interval_ = scene.output.checkpoint_interval;
  CLEAVE_ASSIGN_OR_RETURN(recorded->simulation_,
                          Simulation::Create(scene, std::move(inputs.mesh), {threads}));
  return recorded;
}

absl::Status RecordedSimulation::Begin() {
  if (head() >= 0) {
    CLEAVE_RETURN_IF_ERROR(RestoreNewestCheckpoint());
    return RestoreEncoder();
  }
  CLEAVE_ASSIGN_OR_RETURN(encoder_, FrameEncoder::Create(header_, mesh()));
  CLEAVE_ASSIGN_OR_RETURN(const EncodedFrame encoded, encoder_->Encode(CurrentFrame()));
  CLEAVE_RETURN_IF_ERROR(events_.Append(whole_pieces_));
  return log_.Append(encoder_->header_bytes(), encoded);
}

absl::Status RecordedSimulation::RestoreNewestCheckpoint() {
  CLEAVE_ASSIGN_OR_RETURN(const std::vector<int64_t> frames, checkpoints_.List());
  for (const int64_t frame : frames) {
    if (frame > head()) continue;
    const absl::StatusOr<std::string> state = checkpoints_.Read(frame);
    // A damaged checkpoint, or one of another build, only costs time: an older one, or rest, will
    // do.
    if (!state.ok() || !simulation_->Restore(*state).ok()) continue;
    newest_checkpoint_ = frame;
    break;
  }
  return absl::OkStatus();
}

absl::Status RecordedSimulation::RestoreEncoder() {
  const std::vector<IndexRow>& rows = log_.rows();
  const std::optional<size_t> position = FindFrame(rows, frame());
  const std::optional<size_t> key =
      position.has_value() ? FindKeyframe(rows, *position) : std::nullopt;
  if (!key.has_value()) {
    return absl::DataLossError(absl::StrCat("the frame log has no key frame before ", frame()));
  }
  CLEAVE_ASSIGN_OR_RETURN(FrameDecoder decoder, FrameDecoder::Create(log_.header_bytes(), mesh()));
  for (size_t i = *key; i <= *position; ++i) {
    CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, log_.ReadFrame(rows[i]));
    CLEAVE_RETURN_IF_ERROR(decoder.Apply(bytes));
  }
  CLEAVE_ASSIGN_OR_RETURN(encoder_, FrameEncoder::Create(header_, mesh(), decoder.state()));
  if (encoder_->header_bytes() != log_.header_bytes()) {
    return absl::FailedPreconditionError("the frame log was written for another stream header");
  }
  return absl::OkStatus();
}

absl::Status RecordedSimulation::CatchUp(const StopFlag& stop) {
  CLEAVE_ASSIGN_OR_RETURN(const FrameReport report, simulation_->Advance(stop));
  CLEAVE_ASSIGN_OR_RETURN(const EncodedFrame encoded, encoder_->Encode(CurrentFrame()));
  const std::optional<size_t> position = FindFrame(log_.rows(), frame());
  if (!position.has_value()) {
    return absl::InternalError(absl::StrCat("frame ", frame(), " was never committed"));
  }
  CLEAVE_ASSIGN_OR_RETURN(const std::string committed, log_.ReadFrame(log_.rows()[*position]));
  if (encoded.bytes != committed) {
    return absl::DataLossError(absl::StrCat("frame ", frame(),
                                            " does not come out as it was committed: another "
                                            "build, or a damaged directory"));
  }
  if (frame() > reports_.last_frame()) {
    CLEAVE_RETURN_IF_ERROR(reports_.Append(frame(), ReportLine(report, in_force_)));
  }
  // Only a session of a build without events has committed frames that lack theirs.
  if (frame() > events_.last_frame() && !report.events.empty()) {
    CLEAVE_RETURN_IF_ERROR(events_.Append(EventMessage(report)));
  }
  return absl::OkStatus();
}

absl::StatusOr<FrameReport> RecordedSimulation::Advance(const StopFlag& stop) {
  return simulation_->Advance(stop);
}

absl::Status RecordedSimulation::Commit(const FrameReport& report) {
  CLEAVE_ASSIGN_OR_RETURN(const EncodedFrame encoded, encoder_->Encode(CurrentFrame()));
  // Report and events first: opening cuts those that lead the log, and never misses one.
  CLEAVE_RETURN_IF_ERROR(reports_.Append(report.frame, ReportLine(report, in_force_)));
  if (!report.events.empty()) CLEAVE_RETURN_IF_ERROR(events_.Append(EventMessage(report)));
  CLEAVE_RETURN_IF_ERROR(log_.Append(encoder_->header_bytes(), encoded));
  return head() % checkpoint_interval_ == 0 ? Checkpoint() : absl::OkStatus();
}

absl::Status RecordedSimulation::Checkpoint() {
  // Rest is where a session without checkpoints starts.
  if (frame() == 0 || frame() == newest_checkpoint_) return absl::OkStatus();
  CLEAVE_RETURN_IF_ERROR(checkpoints_.Write(frame(), simulation_->Save()));
  newest_checkpoint_ = frame();
  return absl::OkStatus();
}

Frame RecordedSimulation::CurrentFrame() const {
  return {simulation_->frame(), simulation_->time(), simulation_->fragments(),
          simulation_->positions(), simulation_->broken_edges()};
}

}  // namespace cleave
