#include "server/gateway/rpc/session_calls.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/calls.h"
#include "server/gateway/rpc/session_call.h"
#include "server/gateway/rpc/session_service.h"

namespace cleave {
namespace {

absl::Status GoingDown() { return MakeRetryLater("DRAINING", "the server goes down", 2); }

absl::Status Gone(const HostedSession& session) {
  return MakeError(absl::StatusCode::kNotFound, "SESSION_NOT_FOUND",
                   absl::StrCat(session.name(), " was deleted"));
}

// A command to a session that is answered by its effect: what Step and Pause have in common.
class CommandCall : public grpc::ServerUnaryReactor, public SessionCall {
 public:
  CommandCall(Executor& executor, Drain& drain, SessionStore& sessions,
              grpc::CallbackServerContext* context)
      : SessionCall(executor, drain), sessions_(sessions), answer_time_(AnswerTime(*context)) {}

  using SessionCall::Open;
  void OnCancel() override {
    cancelled_ = true;
    Wake();
  }
  void OnDone() override { Close(); }

 protected:
  // Decides about the call in view of the session's state. Answers with Answer.
  virtual void Follow(const HostedSession::State& state) = 0;
  // The client waits no longer: too late, or gone.
  virtual void GiveUp(const HostedSession::State& state) = 0;

  void Step() override {
    if (answered_) return;
    if (session() == nullptr && !Begin()) return;
    const HostedSession::State state = session()->state();
    if (const absl::Status error = TakeError(); !error.ok()) return Answer(error);
    if (state.deleted) return Answer(Gone(*session()));
    if (going_down()) return Answer(GoingDown());
    const bool late = answer_time_.has_value() && Executor::Clock::now() >= *answer_time_;
    if (cancelled_ || late) return GiveUp(state);
    Follow(state);
  }

  virtual std::string session_name() const = 0;
  virtual absl::Status Check() const { return absl::OkStatus(); }

  void Answer(const absl::Status& status) {
    answered_ = true;
    Finish(ToRpcStatus(status));
  }
  // For the answers of workers, which come on other threads.
  void SetError(const absl::Status& status) {
    const std::lock_guard lock(mutex_);
    error_ = status;
  }

  std::atomic<bool> acknowledged_ = false;

 private:
  bool Begin() {
    absl::Status status = Check();
    if (status.ok()) {
      absl::StatusOr<std::shared_ptr<HostedSession>> found = sessions_.Find(session_name());
      status = found.status();
      if (found.ok()) Attach(*std::move(found));
    }
    if (!status.ok()) Answer(status);
    if (status.ok() && answer_time_.has_value()) WakeAt(*answer_time_);
    return status.ok();
  }
  absl::Status TakeError() {
    const std::lock_guard lock(mutex_);
    return error_;
  }

  SessionStore& sessions_;
  const std::optional<Executor::Clock::time_point> answer_time_;
  std::atomic<bool> cancelled_ = false;
  bool answered_ = false;
  std::mutex mutex_;
  absl::Status error_;
};

class StepCall final : public CommandCall {
 public:
  StepCall(Executor& executor, Drain& drain, SessionStore& sessions,
           grpc::CallbackServerContext* context, const v1::StepSessionRequest* request,
           v1::StepSessionResponse* response)
      : CommandCall(executor, drain, sessions, context), request_(request), response_(response) {}

 private:
  std::string session_name() const override { return request_->name(); }

  absl::Status Check() const override {
    if (request_->frames() >= 1 && request_->frames() <= kMaxStepFrames) return absl::OkStatus();
    return MakeBadField("frames",
                        absl::StrCat(request_->frames(), " is outside [1, ", kMaxStepFrames, "]"));
  }

  void Follow(const HostedSession::State& state) override {
    if (started_) {
      if (acknowledged_ && !state.active) AnswerWith(state, /*deadline_reached=*/false);
      return;
    }
    // A session that is still being loaded, or comes to rest after a pause, is waited for.
    if (state.state == v1::SESSION_STATE_PREPARING || state.state == v1::SESSION_STATE_RECOVERING ||
        state.state == v1::SESSION_STATE_PAUSING) {
      return;
    }
    if (state.active) {
      return Answer(MakeError(absl::StatusCode::kFailedPrecondition, "SESSION_RUNNING",
                              "the session is running; pause it first"));
    }
    if (request_->has_expected_head() && request_->expected_head() != state.head_frame) {
      return Answer(MakeError(
          absl::StatusCode::kAborted, "HEAD_MOVED",
          absl::StrCat("the head is frame ", state.head_frame, ", not ", request_->expected_head()),
          {{"head_frame", absl::StrCat(state.head_frame)}}));
    }
    started_ = true;
    first_head_ = state.head_frame;
    v1::RunGoal goal;
    goal.set_until_frame(first_head_ + request_->frames());
    session()->Run(goal, "", [self = shared_from_this(), this](const absl::Status& status) {
      SetError(status);
      acknowledged_ = true;
      Wake();
    });
  }

  void GiveUp(const HostedSession::State& state) override {
    // What is committed stays; the frame in work would only delay whatever comes next.
    if (started_) session()->Pause(/*abort_step=*/true, [](const absl::Status&) {});
    AnswerWith(state, /*deadline_reached=*/true);
  }

  void AnswerWith(const HostedSession::State& state, bool deadline_reached) {
    const int64_t done = started_ ? state.head_frame - first_head_ : 0;
    *response_->mutable_session() = session()->View(/*with_scene=*/false);
    response_->set_frames_done(static_cast<uint32_t>(std::max<int64_t>(done, 0)));
    response_->set_deadline_reached(deadline_reached && done < request_->frames());
    Answer(absl::OkStatus());
  }

  const v1::StepSessionRequest* const request_;
  v1::StepSessionResponse* const response_;
  bool started_ = false;
  int64_t first_head_ = 0;
};

class PauseCall final : public CommandCall {
 public:
  PauseCall(Executor& executor, Drain& drain, SessionStore& sessions,
            grpc::CallbackServerContext* context, const v1::PauseSessionRequest* request,
            v1::Session* response)
      : CommandCall(executor, drain, sessions, context), request_(request), response_(response) {}

 private:
  std::string session_name() const override { return request_->name(); }

  void Follow(const HostedSession::State& state) override {
    if (!started_) {
      started_ = true;
      session()->Pause(request_->abort_step(),
                       [self = shared_from_this(), this](const absl::Status& status) {
                         SetError(status);
                         acknowledged_ = true;
                         Wake();
                       });
      return;
    }
    if (!acknowledged_ || state.state == v1::SESSION_STATE_PAUSING ||
        state.state == v1::SESSION_STATE_RUNNING) {
      return;
    }
    GiveUp(state);
  }

  void GiveUp(const HostedSession::State&) override {
    *response_ = session()->View(/*with_scene=*/false);
    Answer(absl::OkStatus());
  }

  const v1::PauseSessionRequest* const request_;
  v1::Session* const response_;
  bool started_ = false;
};

class WatchCall final : public grpc::ServerWriteReactor<v1::Session>, public SessionCall {
 public:
  WatchCall(Executor& executor, Drain& drain, SessionStore& sessions, std::string name)
      : SessionCall(executor, drain), sessions_(sessions), name_(std::move(name)) {}

  using SessionCall::Open;
  void OnWriteDone(bool ok) override {
    if (!ok) cancelled_ = true;
    writing_ = false;
    Wake();
  }
  void OnCancel() override {
    cancelled_ = true;
    Wake();
  }
  void OnDone() override { Close(); }

 private:
  void Step() override {
    if (answered_ || writing_) return;
    if (session() == nullptr) {
      absl::StatusOr<std::shared_ptr<HostedSession>> found = sessions_.Find(name_);
      if (!found.ok()) return Answer(found.status());
      Attach(*std::move(found));
    }
    if (cancelled_) return Answer(absl::CancelledError("the client is gone"));
    if (session()->state().deleted) return Answer(absl::OkStatus());
    if (going_down()) return Answer(GoingDown());
    v1::Session view = session()->View(/*with_scene=*/false);
    std::string bytes = view.SerializeAsString();
    if (bytes == last_bytes_) return;
    last_bytes_ = std::move(bytes);
    view_ = std::move(view);
    writing_ = true;
    StartWrite(&view_);
  }

  void Answer(const absl::Status& status) {
    answered_ = true;
    Finish(ToRpcStatus(status));
  }

  SessionStore& sessions_;
  const std::string name_;
  v1::Session view_;
  std::string last_bytes_;
  std::atomic<bool> writing_ = false;
  std::atomic<bool> cancelled_ = false;
  bool answered_ = false;
};

}  // namespace

grpc::ServerUnaryReactor* StartStepCall(Executor& executor, Drain& drain, SessionStore& sessions,
                                        grpc::CallbackServerContext* context,
                                        const v1::StepSessionRequest* request,
                                        v1::StepSessionResponse* response) {
  const auto call =
      std::make_shared<StepCall>(executor, drain, sessions, context, request, response);
  call->Open();
  return call.get();
}

grpc::ServerUnaryReactor* StartPauseCall(Executor& executor, Drain& drain, SessionStore& sessions,
                                         grpc::CallbackServerContext* context,
                                         const v1::PauseSessionRequest* request,
                                         v1::Session* response) {
  const auto call =
      std::make_shared<PauseCall>(executor, drain, sessions, context, request, response);
  call->Open();
  return call.get();
}

grpc::ServerWriteReactor<v1::Session>* StartWatchCall(Executor& executor, Drain& drain,
                                                      SessionStore& sessions,
                                                      const v1::WatchSessionRequest* request) {
  const auto call = std::make_shared<WatchCall>(executor, drain, sessions, request->name());
  call->Open();
  return call.get();
}

}  // namespace cleave
