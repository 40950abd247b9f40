#include "server/worker/rung_log.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/mesh/incidence.h"
#include "core/stream/stream_header.h"
#include "server/files/durable_file.h"

namespace cleave {

absl::StatusOr<std::unique_ptr<RungLog>> RungLog::Open(const SessionPaths& paths,
                                                       const SessionInputs& inputs,
                                                       const worker::v1::Encoding& encoding) {
  std::unique_ptr<RungLog> opened(new RungLog(paths, encoding));
  opened->edges_ = BuildIncidence(inputs.mesh).edges;
  opened->rest_positions_ = inputs.mesh.rest_positions;
  if (opened->surface_) opened->tets_ = inputs.mesh.tets;
  CLEAVE_RETURN_IF_ERROR(opened->MakeHeader(inputs));
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(opened->directory_));
  CLEAVE_ASSIGN_OR_RETURN(const bool goes_on, opened->Resume());
  if (!goes_on) CLEAVE_RETURN_IF_ERROR(opened->Begin());
  return opened;
}

absl::Status RungLog::MakeHeader(const SessionInputs& inputs) {
  CLEAVE_ASSIGN_OR_RETURN(kept_header_bytes_, kept_.ReadHeader());
  CLEAVE_ASSIGN_OR_RETURN(const StreamHeader kept, ParseStreamHeader(kept_header_bytes_));
  StreamParameters parameters;
  parameters.mesh_sha256 = kept.mesh_sha256;
  parameters.edge_count = kept.edge_count;
  parameters.tet_count = kept.tet_count;
  parameters.tolerance = tolerance_;
  parameters.keyframe_interval = kept.keyframe_interval;
  parameters.frames_per_second = kept.frames_per_second;
  ChooseIds(inputs.mesh.rest_positions, parameters);
  parameters.regions = region_.has_value();
  parameters.view_id = surface_ ? kViewSurface : kViewState;
  CLEAVE_ASSIGN_OR_RETURN(header_, MakeStreamHeader(parameters, inputs.mesh.rest_positions));
  return absl::OkStatus();
}

absl::StatusOr<bool> RungLog::Resume() {
  absl::StatusOr<FrameLogWriter> log = FrameLogWriter::Open(directory_);
  if (IsLogDamage(log.status())) return false;
  CLEAVE_ASSIGN_OR_RETURN(log_, std::move(log));
  if (head() < 0) return false;
  if (log_->header_bytes() != SerializeStreamHeader(header_)) return false;  // of another build
  CLEAVE_RETURN_IF_ERROR(kept_.Refresh(head()));
  if (kept_.head() != head()) return false;
  const int64_t key = kept_.Keyframe(head())->frame;
  CLEAVE_ASSIGN_OR_RETURN(decoder_, FrameDecoder::Create(kept_header_bytes_, mesh()));
  CLEAVE_ASSIGN_OR_RETURN(FrameDecoder own, FrameDecoder::Create(log_->header_bytes(), mesh()));
  for (int64_t frame = key; frame <= head(); ++frame) {
    CLEAVE_ASSIGN_OR_RETURN(const std::string kept, kept_.ReadFrame(*kept_.Find(frame)));
    CLEAVE_RETURN_IF_ERROR(decoder_->Apply(kept));
    const absl::StatusOr<std::string> bytes =
        log_->ReadFrame(log_->rows()[static_cast<size_t>(frame)]);
    if (IsLogDamage(bytes.status())) return false;
    if (!bytes.ok()) return bytes.status();
    if (!own.Apply(*bytes).ok()) return false;
  }
  CLEAVE_RETURN_IF_ERROR(MakeEncoder(own.state()));
  return true;
}

absl::Status RungLog::MakeEncoder(std::optional<StreamState> state) {
  CLEAVE_ASSIGN_OR_RETURN(encoder_, FrameEncoder::Create(header_, mesh(), std::move(state)));
  return region_.has_value() ? encoder_->SetRegion(region_) : absl::OkStatus();
}

absl::Status RungLog::Begin() {
  log_.reset();
  std::error_code error;
  std::filesystem::remove_all(directory_, error);
  if (error) return absl::ErrnoToStatus(error.value(), absl::StrCat("cannot remove ", directory_));
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(directory_));
  CLEAVE_ASSIGN_OR_RETURN(log_, FrameLogWriter::Open(directory_));
  CLEAVE_ASSIGN_OR_RETURN(decoder_, FrameDecoder::Create(kept_header_bytes_, mesh()));
  return MakeEncoder(std::nullopt);
}

absl::Status RungLog::EncodeNext() {
  CLEAVE_ASSIGN_OR_RETURN(const std::string kept, kept_.ReadFrame(*kept_.Find(head() + 1)));
  CLEAVE_RETURN_IF_ERROR(decoder_->Apply(kept));
  CLEAVE_ASSIGN_OR_RETURN(const EncodedFrame encoded, encoder_->Encode(decoder_->frame()));
  return log_->Append(encoder_->header_bytes(), encoded);
}

}  // namespace cleave
