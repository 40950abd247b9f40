#ifndef CLEAVE_SERVER_GATEWAY_RPC_FRAME_STREAM_CALL_H_
#define CLEAVE_SERVER_GATEWAY_RPC_FRAME_STREAM_CALL_H_

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "cleave/v1/frame.pb.h"
#include "server/gateway/drain.h"
#include "server/gateway/executor.h"
#include "server/gateway/frame_choice.h"
#include "server/gateway/rpc/session_call.h"
#include "server/gateway/session_store.h"
#include "server/session/event_log.h"

namespace cleave {

// One StreamFrames call: reads committed frames from the session's log, or from that of a coarser
// rung or a region, and sends them in chunks, with one write under way at a time, so that a slow
// viewer costs one chunk of memory and nobody else any time.
class FrameStreamCall final : public grpc::ServerWriteReactor<v1::StreamFramesResponse>,
                              public SessionCall {
 public:
  FrameStreamCall(Executor& executor, Drain& drain, SessionStore& sessions,
                  const v1::StreamFramesRequest& request)
      : SessionCall(executor, drain), sessions_(sessions), request_(request) {}

  using SessionCall::Open;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  void Step() override;
  absl::Status Begin();
  absl::Status CheckRequest() const;
  // Chooses what is sent, from which frame on; false while that is not there yet.
  absl::StatusOr<bool> Start(const HostedSession::State& state);
  // False while the session has no frame yet.
  absl::StatusOr<bool> Choose(const HostedSession::State& state);
  // Takes note of new frames of the log that is sent.
  absl::Status Refresh(const HostedSession::State& state);
  // Of the log that is sent.
  FrameLogReader& frames() {
    return encoding_.empty() ? session()->frames() : session()->rungs().frames(encoding_);
  }
  // Sends the next piece of what is due.
  absl::Status Continue(const HostedSession::State& state);
  absl::Status LoadNextFrame();
  // Where the viewer wants to be at the newest and is behind: leaves out what is before the newest
  // key frame, and says so.
  bool SkipToNewestKeyframe();
  // Nothing is due: a heartbeat now and then.
  void Rest(const HostedSession::State& state);
  void SendEvents();
  // Reads the events of a frame, and keeps up what pieces there are.
  absl::StatusOr<v1::FrameEvents> ReadEvents(int64_t frame);
  void SendChunk(int64_t head_frame);
  void SendEnd(v1::EndReason reason, const std::string& message);
  void Send();
  void Answer(const absl::Status& status);

  SessionStore& sessions_;
  const v1::StreamFramesRequest request_;
  v1::StreamFramesResponse message_;

  std::optional<FrameChoice> choice_;  // what is sent, once that is known
  std::string encoding_;               // where that is encoded anew: its name
  int64_t head_ = -1;                  // newest frame of it that may be sent
  bool started_ = false;
  bool ended_ = false;     // StreamEnd was sent
  bool answered_ = false;  // Finish was called
  int64_t next_frame_ = 0;
  std::string frame_bytes_;                  // of next_frame_, while it is being sent
  size_t frame_sent_ = 0;                    // bytes of it
  std::optional<EventLogReader> event_log_;  // where events were asked for
  v1::FrameEvents events_;                   // of next_frame_, yet to be sent
  std::map<int32_t, v1::Piece> pieces_;      // after the frame before next_events_
  int64_t next_events_ = 0;                  // first frame whose events were not read
  bool tell_pieces_ = false;                 // before the next frame
  Executor::Clock::time_point last_write_;
  std::atomic<bool> writing_ = false;
  std::atomic<bool> cancelled_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_FRAME_STREAM_CALL_H_
