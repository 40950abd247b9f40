#include "server/gateway/rpc/frame_stream_call.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/stream/stream_header.h"
#include "proto/convert/rung.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/status.h"

namespace cleave {
namespace {

constexpr uint32_t kDefaultChunkBytes = 256 << 10;
constexpr uint32_t kMinChunkBytes = 16 << 10;
constexpr uint32_t kMaxChunkBytes = 1 << 20;
constexpr std::chrono::seconds kHeartbeat{5};
constexpr int kEventsPerMessage = 1000;  // edges below 200 KB; a split has all of its parts

absl::Status Deleted(const HostedSession& session) {
  return MakeError(absl::StatusCode::kNotFound, "SESSION_NOT_FOUND",
                   absl::StrCat(session.name(), " was deleted"));
}

}  // namespace

void FrameStreamCall::OnWriteDone(bool ok) {
  if (!ok) cancelled_ = true;
  writing_ = false;
  Wake();
}

void FrameStreamCall::OnCancel() {
  cancelled_ = true;
  Wake();
}

void FrameStreamCall::OnDone() {
  if (session() != nullptr) session()->AddViewer(-1);
  if (!encoding_.empty()) session()->rungs().RemoveViewer(encoding_);
  Close();
}

void FrameStreamCall::Step() {
  if (answered_ || writing_) return;
  if (session() == nullptr) {
    if (const absl::Status status = Begin(); !status.ok()) return Answer(status);
  }
  if (cancelled_) return Answer(absl::CancelledError("the client is gone"));
  if (ended_) return Answer(absl::OkStatus());
  // Head and activity in one look: a session that rests has no frame beyond this head.
  const HostedSession::State state = session()->state();
  absl::Status status = Refresh(state);
  if (status.ok()) status = Continue(state);
  if (!status.ok()) Answer(status);
}

absl::Status FrameStreamCall::CheckRequest() const {
  Faults faults;
  const uint32_t chunk = request_.max_chunk_bytes();
  if (chunk != 0 && (chunk < kMinChunkBytes || chunk > kMaxChunkBytes)) {
    faults.Error("max_chunk_bytes", absl::StrCat(chunk, " is neither 0 nor in [", kMinChunkBytes,
                                                 ", ", kMaxChunkBytes, "]"));
  }
  if (request_.first_frame() < 0) {
    faults.Error("first_frame", absl::StrCat(request_.first_frame(), " is negative"));
  }
  if (request_.has_stop_frame() && request_.stop_frame() < 0) {
    faults.Error("stop_frame", absl::StrCat(request_.stop_frame(), " is negative"));
  }
  CheckFrameChoice(request_, faults);
  return faults.ok() ? absl::OkStatus() : MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
}

absl::Status FrameStreamCall::Begin() {
  CLEAVE_RETURN_IF_ERROR(CheckRequest());
  CLEAVE_ASSIGN_OR_RETURN(std::shared_ptr<HostedSession> session,
                          sessions_.Find(request_.session()));
  session->AddViewer(1);
  if (request_.events()) event_log_.emplace(session->paths().events());
  Attach(std::move(session));
  return absl::OkStatus();
}

absl::Status FrameStreamCall::Refresh(const HostedSession::State& state) {
  CLEAVE_RETURN_IF_ERROR(session()->frames().Refresh(state.head_frame));
  head_ = session()->frames().head();
  if (encoding_.empty()) return absl::OkStatus();
  const RungEncoders::State rung = session()->rungs().state(encoding_);
  head_ = std::min(head_, rung.head_frame);
  if (head_ < session()->frames().head() && !rung.failure.ok()) {
    return MakeError(absl::StatusCode::kInternal, "RUNG_FAILED",
                     absl::StrCat("the rung ", encoding_, " of ", session()->name(),
                                  head_ < 0 ? absl::StrCat(" has no frame")
                                            : absl::StrCat(" ends at frame ", head_),
                                  ": ", rung.failure.message()));
  }
  return frames().Refresh(head_);
}

absl::Status FrameStreamCall::Continue(const HostedSession::State& state) {
  if (!started_) {
    CLEAVE_ASSIGN_OR_RETURN(started_, Start(state));
    return absl::OkStatus();
  }
  if (state.deleted) {
    SendEnd(v1::END_REASON_DELETED, "");
  } else if (going_down()) {
    SendEnd(v1::END_REASON_SHUTDOWN, "the server goes down; go on where you are when it is back");
  } else if (events_.pieces_size() > 0 || events_.edge_breaks_size() > 0 ||
             events_.splits_size() > 0) {
    SendEvents();
  } else if (!frame_bytes_.empty()) {
    SendChunk(state.head_frame);
  } else if (request_.has_stop_frame() && next_frame_ > request_.stop_frame()) {
    SendEnd(v1::END_REASON_STOP_FRAME, "");
  } else if (SkipToNewestKeyframe()) {
    return absl::OkStatus();
  } else if (next_frame_ <= head_) {
    CLEAVE_RETURN_IF_ERROR(LoadNextFrame());
    return Continue(state);
  } else if (head_ < session()->frames().head()) {
    Rest(state);  // the rung is on its way there
  } else if (state.state == v1::SESSION_STATE_FAILED && !state.active) {
    SendEnd(v1::END_REASON_FAILED, absl::StrCat(state.error.reason(), ": ", state.error.message()));
  } else if (!state.active && !request_.follow()) {
    SendEnd(v1::END_REASON_GOAL_REACHED, "");
  } else {
    Rest(state);
  }
  return absl::OkStatus();
}

void FrameStreamCall::Rest(const HostedSession::State& state) {
  if (Executor::Clock::now() - last_write_ < kHeartbeat) return WakeAt(last_write_ + kHeartbeat);
  message_.mutable_heartbeat()->set_head_frame(state.head_frame);
  Send();
}

absl::StatusOr<bool> FrameStreamCall::Choose(const HostedSession::State& state) {
  const FrameLogReader& kept = session()->frames();
  if (kept.head() < 0) {
    if (state.deleted) return Deleted(*session());
    if (going_down()) return MakeRetryLater("DRAINING", "the server goes down", 2);
    if (state.active) return false;  // its first frame is on the way
    if (state.state == v1::SESSION_STATE_FAILED) {
      return MakeError(
          absl::StatusCode::kFailedPrecondition, state.error.reason(),
          absl::StrCat("the session failed before its first frame: ", state.error.message()));
    }
    CLEAVE_RETURN_IF_ERROR(session()->StartWorker());
    return false;
  }
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, kept.ReadHeader());
  CLEAVE_ASSIGN_OR_RETURN(const StreamHeader header, ParseStreamHeader(bytes));
  CLEAVE_ASSIGN_OR_RETURN(FrameChoice choice, ChooseFrames(request_, header));
  if (choice.encoding.has_value()) {
    const absl::Status added = session()->rungs().AddViewer(*choice.encoding);
    if (absl::IsUnavailable(added)) {
      return MakeRetryLater("TOO_MANY_REGIONS", added.message(), 1);
    }
    if (!added.ok()) {
      return MakeError(added.code(), "TOO_MANY_REGIONS",
                       absl::StrCat(session()->name(), ": ", added.message()));
    }
    encoding_ = choice.encoding->name();
  }
  choice_ = std::move(choice);
  if (encoding_.empty()) return true;
  CLEAVE_RETURN_IF_ERROR(Refresh(state));
  return true;
}

absl::StatusOr<bool> FrameStreamCall::Start(const HostedSession::State& state) {
  if (!choice_.has_value()) {
    CLEAVE_ASSIGN_OR_RETURN(const bool chosen, Choose(state));
    if (!chosen) return false;
  }
  // A rung that is not yet where the viewer wants to begin is on its way there.
  const int64_t wanted = request_.has_resume() ? request_.resume().frame() : request_.first_frame();
  const int64_t begin = std::clamp<int64_t>(wanted, 0, session()->frames().head());
  if (head_ < begin) {
    if (state.deleted) return Deleted(*session());
    if (going_down()) return MakeRetryLater("DRAINING", "the server goes down", 2);
    return false;
  }
  v1::StreamStart& start = *message_.mutable_start();
  const v1::Resume& resume = request_.resume();
  const std::optional<IndexRow> held =
      request_.has_resume() ? frames().Find(resume.frame()) : std::nullopt;
  if (held.has_value() && held->epoch == resume.epoch() &&
      held->state_hash == resume.state_hash()) {
    start.set_resumed(true);
    next_frame_ = held->frame + 1;
  } else {
    // A client that holds something else than this log begins again near where it was.
    const std::optional<IndexRow> key = frames().Keyframe(begin);
    if (!key.has_value()) return absl::DataLossError("the frame log has no key frame");
    next_frame_ = key->frame;
  }
  CLEAVE_ASSIGN_OR_RETURN(*start.mutable_header(), frames().ReadHeader());
  start.set_rung(RungMessage(choice_->rung));
  start.set_tolerance(choice_->tolerance);
  start.set_outside_tolerance(choice_->outside_tolerance);
  tell_pieces_ = !start.resumed();
  start.set_first_frame(next_frame_);
  start.set_mesh_asset(session()->config().scene().mesh().asset());
  Send();
  return true;
}

bool FrameStreamCall::SkipToNewestKeyframe() {
  if (!request_.latest() || next_frame_ >= head_) return false;
  const std::optional<IndexRow> key =
      frames().Keyframe(request_.has_stop_frame() ? std::min(head_, request_.stop_frame()) : head_);
  if (!key.has_value() || key->frame <= next_frame_) return false;
  v1::Gap& gap = *message_.mutable_gap();
  gap.set_first_frame(next_frame_);
  gap.set_last_frame(key->frame - 1);
  next_frame_ = key->frame;
  tell_pieces_ = true;
  Send();
  return true;
}

absl::Status FrameStreamCall::LoadNextFrame() {
  const std::optional<IndexRow> row = frames().Find(next_frame_);
  if (!row.has_value()) {
    return MakeError(absl::StatusCode::kOutOfRange, "FRAME_NOT_RETAINED",
                     absl::StrCat("frame ", next_frame_, " is not in the log"));
  }
  CLEAVE_ASSIGN_OR_RETURN(frame_bytes_, frames().ReadFrame(*row));
  frame_sent_ = 0;
  if (!event_log_.has_value()) return absl::OkStatus();
  while (next_events_ < next_frame_) CLEAVE_RETURN_IF_ERROR(ReadEvents(next_events_).status());
  const std::map<int32_t, v1::Piece> before = tell_pieces_ ? pieces_ : decltype(pieces_)();
  CLEAVE_ASSIGN_OR_RETURN(events_, ReadEvents(next_frame_));
  if (!std::exchange(tell_pieces_, false) || events_.pieces_size() > 0) return absl::OkStatus();
  for (const auto& [id, piece] : before) *events_.add_pieces() = piece;
  return absl::OkStatus();
}

absl::StatusOr<v1::FrameEvents> FrameStreamCall::ReadEvents(int64_t frame) {
  CLEAVE_ASSIGN_OR_RETURN(std::optional<v1::FrameEvents> events, event_log_->Read(frame));
  next_events_ = frame + 1;
  if (!events.has_value()) return v1::FrameEvents();
  for (const v1::Piece& piece : events->pieces()) pieces_[piece.piece()] = piece;
  // Of a session that never noted the pieces of its mesh, nothing is told rather than some.
  if (pieces_.empty()) return *std::move(events);
  for (const v1::PieceSplit& split : events->splits()) {
    pieces_[split.kept().piece()] = split.kept();
    for (const v1::Separation& part : split.separations()) {
      pieces_[part.part().piece()] = part.part();
    }
  }
  return *std::move(events);
}

// Moves the first of what is left of the frame's events into the message.
void FrameStreamCall::SendEvents() {
  v1::FrameEvents& sent = *message_.mutable_events();
  sent.Clear();
  sent.set_frame(next_frame_);
  const auto move_some = [](auto& from, auto& to, int room) {
    const int count = std::min(room, from.size());
    for (int i = 0; i < count; ++i) to.Add()->Swap(from.Mutable(i));
    from.DeleteSubrange(0, count);
  };
  move_some(*events_.mutable_pieces(), *sent.mutable_pieces(), kEventsPerMessage);
  if (events_.pieces_size() > 0) return Send();
  move_some(*events_.mutable_edge_breaks(), *sent.mutable_edge_breaks(), kEventsPerMessage);
  if (events_.edge_breaks_size() == 0)
    move_some(*events_.mutable_splits(), *sent.mutable_splits(), kEventsPerMessage);
  Send();
}

void FrameStreamCall::SendChunk(int64_t head_frame) {
  const size_t chunk_bytes =
      request_.max_chunk_bytes() == 0 ? kDefaultChunkBytes : request_.max_chunk_bytes();
  const size_t size = std::min(chunk_bytes, frame_bytes_.size() - frame_sent_);
  v1::FrameChunk& chunk = *message_.mutable_chunk();
  chunk.set_frame(next_frame_);
  chunk.set_offset(frame_sent_);
  chunk.set_frame_bytes(frame_bytes_.size());
  chunk.set_payload(frame_bytes_.data() + frame_sent_, size);
  chunk.set_head_frame(head_frame);
  frame_sent_ += size;
  if (frame_sent_ == frame_bytes_.size()) {
    frame_bytes_.clear();
    ++next_frame_;
  }
  Send();
}

void FrameStreamCall::SendEnd(v1::EndReason reason, const std::string& message) {
  v1::StreamEnd& end = *message_.mutable_end();
  end.set_last_frame(next_frame_ - 1);
  end.set_reason(reason);
  end.set_message(message);
  ended_ = true;
  Send();
}

void FrameStreamCall::Send() {
  writing_ = true;
  last_write_ = Executor::Clock::now();
  StartWrite(&message_);
}

void FrameStreamCall::Answer(const absl::Status& status) {
  answered_ = true;
  Finish(ToRpcStatus(status));
}

}  // namespace cleave
