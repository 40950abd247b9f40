#include "client/cpp/frame_stream.h"

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cpp/rpc_error.h"
#include "client/cpp/stubs.h"
#include "core/base/status.h"
#include "proto/convert/rung.h"

namespace cleave {
namespace {

// Above any frame of the largest mesh; memory is taken as bytes come, not as they are announced.
constexpr uint64_t kMaxFrameBytes = uint64_t{2} << 30;

// A server that restarts may replay for a while: patience of about two minutes.
constexpr int kMaxAttempts = 30;

// A cut shows as one of these, or as a good end without StreamEnd.
bool IsCut(const absl::Status& status) { return absl::IsUnavailable(status); }

}  // namespace

// The call that runs; its reader goes before its context.
struct FrameStream::Call {
  grpc::ClientContext context;
  std::unique_ptr<grpc::ClientReader<v1::StreamFramesResponse>> reader;
};

FrameStream::FrameStream(Client& client, FrameStreamOptions options)
    : client_(client), options_(std::move(options)), position_(options_.resume) {}

FrameStream::~FrameStream() { Disconnect(); }

bool FrameStream::cancelled() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return cancelled_;
}

void FrameStream::Cancel() {
  const std::lock_guard<std::mutex> lock(mutex_);
  cancelled_ = true;
  if (call_ != nullptr) call_->context.TryCancel();
}

void FrameStream::Disconnect() {
  if (call_ == nullptr) return;
  call_->context.TryCancel();
  v1::StreamFramesResponse rest;
  while (call_->reader->Read(&rest)) {
  }
  call_->reader->Finish();  // its status was read, or is the cancellation just made
  const std::lock_guard<std::mutex> lock(mutex_);
  call_.reset();
}

absl::Status FrameStream::Connect() {
  v1::StreamFramesRequest request;
  request.set_session(options_.session);
  request.set_first_frame(options_.first_frame);
  request.set_follow(options_.follow);
  request.set_events(options_.events);
  if (options_.stop_frame.has_value()) request.set_stop_frame(*options_.stop_frame);
  if (options_.tolerance.has_value()) request.set_tolerance(*options_.tolerance);
  if (options_.rung.has_value()) request.set_rung(RungMessage(options_.rung));
  if (options_.region.has_value()) *request.mutable_region() = *options_.region;
  if (options_.surface) request.set_view(v1::FRAME_VIEW_SURFACE);
  request.set_latest(options_.latest);
  if (position_.has_value()) {
    request.set_first_frame(position_->frame + 1);
    request.mutable_resume()->set_epoch(position_->epoch);
    request.mutable_resume()->set_frame(position_->frame);
    request.mutable_resume()->set_state_hash(position_->state_hash);
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (cancelled_) return absl::CancelledError("the frame stream was cancelled");
    call_ = std::make_unique<Call>();
  }
  call_->reader = client_.stubs().frames->StreamFrames(&call_->context, request);
  assembly_.clear();
  assembly_bytes_ = 0;
  events_.Clear();
  gap_.reset();
  v1::StreamFramesResponse response;
  if (!call_->reader->Read(&response)) {
    const grpc::Status status = call_->reader->Finish();
    const std::lock_guard<std::mutex> lock(mutex_);
    call_.reset();
    if (status.ok()) return absl::UnavailableError("the frame stream ended before it began");
    return StatusFromRpc(status, absl::StrCat("streaming frames of ", options_.session));
  }
  if (!response.has_start())
    return absl::DataLossError("the frame stream does not begin with its header");
  if (start_.has_value() && (start_->header() != response.start().header() ||
                             start_->mesh_asset() != response.start().mesh_asset()))
    return absl::FailedPreconditionError(
        absl::StrCat(options_.session, " is another session now than the one that was streamed"));
  if (!start_.has_value()) {
    CLEAVE_RETURN_IF_ERROR(ParseStreamHeader(response.start().header()).status());
    if (options_.rest_positions.has_value()) {
      auto decoder = FrameDecoder::Create(
          response.start().header(), {*options_.rest_positions, options_.edges, options_.tets});
      if (!decoder.ok()) return decoder.status();
      decoder_.emplace(*std::move(decoder));
    }
  }
  // A decoder that holds nothing cannot take deltas up to a frame that only the caller holds.
  if (response.start().resumed() && decoder_.has_value() &&
      decoder_->frame().frame != position_->frame)
    return absl::FailedPreconditionError("a stream that is decoded begins at a key frame");
  start_ = std::move(*response.mutable_start());
  return absl::OkStatus();
}

std::optional<Rung> FrameStream::rung() const { return RungFromMessage(start_->rung()); }

absl::Status FrameStream::Recover(const absl::Status& why) {
  Disconnect();
  if (cancelled() || (client_.stop() != nullptr && client_.stop()->requested()))
    return absl::CancelledError("the frame stream was cancelled");
  if (!IsCut(why)) return why;
  RetryPolicy policy = client_.policy();
  policy.max_attempts = kMaxAttempts;
  const auto delay = RetryDelay(policy, ++attempts_, why);
  if (!delay.has_value()) return why;
  if (options_.on_cut) options_.on_cut(why, *delay);
  if (!WaitUnlessStopped(*delay, client_.stop()))
    return absl::CancelledError("the frame stream was cancelled");
  return absl::OkStatus();
}

absl::Status FrameStream::Open() {
  while (call_ == nullptr) {
    const absl::Status status = Connect();
    if (status.ok()) break;
    CLEAVE_RETURN_IF_ERROR(Recover(status));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::optional<StreamedFrame>> FrameStream::Next() {
  while (!end_.has_value()) {
    CLEAVE_RETURN_IF_ERROR(Open());
    auto frame = ReadOne();
    if (frame.ok() && frame->has_value()) {
      attempts_ = 0;
      return frame;
    }
    if (!frame.ok()) CLEAVE_RETURN_IF_ERROR(Recover(frame.status()));
  }
  Disconnect();
  return std::nullopt;
}

absl::Status FrameStream::AddChunk(const v1::FrameChunk& chunk, bool& whole) {
  head_frame_ = std::max(head_frame_, chunk.head_frame());
  if (assembly_bytes_ == 0) {
    assembly_frame_ = chunk.frame();
    assembly_bytes_ = chunk.frame_bytes();
    assembly_.clear();
  }
  if (chunk.frame() != assembly_frame_ || chunk.frame_bytes() != assembly_bytes_ ||
      chunk.offset() != assembly_.size() || chunk.payload().empty() ||
      assembly_bytes_ > kMaxFrameBytes ||
      chunk.payload().size() > assembly_bytes_ - assembly_.size())
    return absl::DataLossError(
        absl::StrCat("a piece of frame ", chunk.frame(), " does not fit the pieces before it"));
  assembly_.append(chunk.payload());
  whole = assembly_.size() == assembly_bytes_;
  return absl::OkStatus();
}

absl::Status FrameStream::AddEvents(const v1::FrameEvents& events) {
  if (events_.frame() != 0 && events_.frame() != events.frame())
    return absl::DataLossError(absl::StrCat("events of frame ", events.frame(),
                                            " came between those of frame ", events_.frame(),
                                            " and the frame"));
  events_bytes_ += events.ByteSizeLong();
  if (events_bytes_ > kMaxFrameBytes)
    return absl::DataLossError(
        absl::StrCat("events of frame ", events.frame(), " take more than a frame may"));
  events_.MergeFrom(events);
  return absl::OkStatus();
}

absl::Status FrameStream::AddGap(const v1::Gap& gap) {
  const bool is_due = options_.latest && assembly_bytes_ == 0 && !gap_.has_value();
  if (!is_due || gap.first_frame() < 0 || gap.last_frame() < gap.first_frame())
    return absl::DataLossError(absl::StrCat("frames ", gap.first_frame(), " to ", gap.last_frame(),
                                            " are said to be left out where none may be"));
  gap_ = FrameGap{gap.first_frame(), gap.last_frame()};
  return absl::OkStatus();
}

absl::Status FrameStream::TakeGap(const FrameHeader& header, std::optional<FrameGap>& gap) {
  if (!gap_.has_value()) return absl::OkStatus();
  gap.swap(gap_);
  if (header.kind != FrameKind::kKey || header.frame != gap->last_frame + 1)
    return absl::DataLossError(absl::StrCat("frames up to ", gap->last_frame,
                                            " are left out, but frame ", header.frame,
                                            " is not the key frame behind them"));
  // A server that cannot resume counts from the key frame where it began.
  if (position_.has_value() && header.epoch == position_->epoch)
    gap->first_frame = std::max(gap->first_frame, position_->frame + 1);
  if (gap->first_frame > gap->last_frame) gap.reset();
  return absl::OkStatus();
}

absl::StatusOr<std::optional<StreamedFrame>> FrameStream::ReadOne() {
  v1::StreamFramesResponse response;
  while (call_->reader->Read(&response)) {
    if (response.has_heartbeat()) {
      head_frame_ = std::max(head_frame_, response.heartbeat().head_frame());
    } else if (response.has_end()) {
      if (response.end().reason() == v1::END_REASON_SHUTDOWN)
        return absl::UnavailableError("the server shuts down");
      end_ = response.end();
      return std::nullopt;
    } else if (response.has_events()) {
      CLEAVE_RETURN_IF_ERROR(AddEvents(response.events()));
    } else if (response.has_gap()) {
      CLEAVE_RETURN_IF_ERROR(AddGap(response.gap()));
    } else if (response.has_chunk()) {
      bool whole = false;
      CLEAVE_RETURN_IF_ERROR(AddChunk(response.chunk(), whole));
      if (!whole) continue;
      assembly_bytes_ = 0;
      auto frame = Accept(std::move(assembly_));
      assembly_.clear();
      if (!frame.ok() || frame->has_value()) return frame;
    }
  }
  const grpc::Status status = call_->reader->Finish();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    call_.reset();
  }
  if (status.ok()) return absl::UnavailableError("the frame stream was cut");
  return StatusFromRpc(status, absl::StrCat("streaming frames of ", options_.session));
}

// Gives nullopt for a frame that was given before: a server that cannot resume begins at a key
// frame, and frames of one epoch have the same bytes whenever they are sent.
absl::StatusOr<std::optional<StreamedFrame>> FrameStream::Accept(std::string bytes) {
  StreamedFrame frame;
  v1::FrameEvents events;
  events.Swap(&events_);
  events_bytes_ = 0;
  {
    const absl::StatusOr<FrameParts> parts = SplitFrame(bytes);
    if (!parts.ok()) return parts.status();
    frame.header = parts->header;
  }
  const FrameHeader& header = frame.header;
  if (position_.has_value() && header.epoch == position_->epoch &&
      header.frame <= position_->frame) {
    if (header.frame == position_->frame && header.state_hash != position_->state_hash)
      return absl::DataLossError(
          absl::StrCat("frame ", header.frame, " is not the one that was given under this number"));
    gap_.reset();  // of frames before one that was given
    return std::nullopt;
  }
  const bool continues = position_.has_value() && header.epoch == position_->epoch &&
                         header.base_frame == position_->frame;
  if (header.kind != FrameKind::kKey && !continues)
    return absl::DataLossError(absl::StrCat("frame ", header.frame, " builds on frame ",
                                            header.base_frame, ", which was not sent"));
  if (events.frame() != 0 && events.frame() != header.frame)
    return absl::DataLossError(
        absl::StrCat("events of frame ", events.frame(), " came before frame ", header.frame));
  CLEAVE_RETURN_IF_ERROR(TakeGap(header, frame.gap));
  if (decoder_.has_value()) CLEAVE_RETURN_IF_ERROR(decoder_->Apply(bytes));
  frame.events = std::move(events);
  position_ = FramePosition{header.epoch, header.frame, header.state_hash};
  head_frame_ = std::max(head_frame_, header.frame);
  frame.bytes = std::move(bytes);
  return frame;
}

}  // namespace cleave
