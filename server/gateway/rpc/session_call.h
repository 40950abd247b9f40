#ifndef CLEAVE_SERVER_GATEWAY_RPC_SESSION_CALL_H_
#define CLEAVE_SERVER_GATEWAY_RPC_SESSION_CALL_H_

#include <atomic>
#include <functional>
#include <memory>
#include <utility>

#include "server/gateway/drain.h"
#include "server/gateway/executor.h"
#include "server/gateway/hosted_session.h"

namespace cleave {

// What a call that stays open on a session needs: it is woken by every change of the session, by
// the server's going down and by timers, and then runs its one step function on the executor, never
// twice at once. A call derives from this and from a gRPC reactor, begins with Open, and gives
// itself to Close in OnDone.
class SessionCall : public std::enable_shared_from_this<SessionCall> {
 public:
  virtual ~SessionCall() = default;

 protected:
  SessionCall(Executor& executor, Drain& drain)
      : executor_(executor), drain_(drain), pump_(executor, [this] { Step(); }) {}

  // Looks at everything and does what is due. Runs on the executor.
  virtual void Step() = 0;

  // Keeps the call alive until Close, and runs Step for the first time.
  void Open() {
    self_ = shared_from_this();
    drain_call_ = drain_.Enter([weak = weak_from_this()] { WakeIfAlive(weak); });
    Wake();
  }
  void Attach(std::shared_ptr<HostedSession> session) {
    session_ = std::move(session);
    observer_ = session_->Observe([weak = weak_from_this()] { WakeIfAlive(weak); });
  }
  void Wake() { pump_.Wake(shared_from_this()); }
  // Wakes at a time; a later call replaces the earlier.
  void WakeAt(Executor::Clock::time_point time) {
    executor_.Cancel(timer_);
    timer_ = executor_.SubmitAt(time, [weak = weak_from_this()] { WakeIfAlive(weak); });
  }
  // The last thing a call does; it may be gone afterwards.
  void Close() {
    executor_.Cancel(timer_.load());
    if (session_ != nullptr) session_->Forget(observer_);
    drain_.Leave(drain_call_);
    const std::shared_ptr<SessionCall> last = std::move(self_);
  }

  bool going_down() const { return drain_.begun(); }
  const std::shared_ptr<HostedSession>& session() const { return session_; }

 private:
  static void WakeIfAlive(const std::weak_ptr<SessionCall>& weak) {
    if (const std::shared_ptr<SessionCall> self = weak.lock()) self->Wake();
  }

  Executor& executor_;
  Drain& drain_;
  Pump pump_;
  std::shared_ptr<SessionCall> self_;
  std::shared_ptr<HostedSession> session_;
  HostedSession::ObserverId observer_ = 0;
  Drain::CallId drain_call_ = 0;
  std::atomic<Executor::TimerId> timer_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_SESSION_CALL_H_
