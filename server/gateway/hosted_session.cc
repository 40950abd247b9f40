#include "server/gateway/hosted_session.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "server/gateway/errors.h"
#include "server/gateway/log.h"
#include "server/session/journal.h"

namespace cleave {
namespace {

// A worker that ends this often without committing a frame in between ends the same way again.
constexpr int kMaxRestarts = 3;

bool Works(v1::SessionState state) {
  return state == v1::SESSION_STATE_PREPARING || state == v1::SESSION_STATE_RECOVERING ||
         state == v1::SESSION_STATE_RUNNING || state == v1::SESSION_STATE_PAUSING;
}

absl::Status WorkerError(const absl::Status& status) {
  if (status.ok() || status.GetPayload(absl::StrCat(kTypeUrlPrefix, "google.rpc.ErrorInfo"))) {
    return status;
  }
  if (absl::IsUnavailable(status)) return MakeRetryLater("WORKER_LOST", status.message(), 1);
  if (absl::IsResourceExhausted(status)) {
    return MakeError(status.code(), "DISK_FULL", status.message());
  }
  return MakeError(status.code(), "WORKER_REFUSED", status.message());
}

}  // namespace

HostedSession::HostedSession(SessionPaths paths, worker::v1::SessionConfig config,
                             const WorkerOptions& options)
    : paths_(std::move(paths)),
      config_(std::move(config)),
      options_(options),
      frames_(paths_.frames()) {}

absl::Status HostedSession::Load() {
  rungs_ = std::make_shared<RungEncoders>(paths_, options_.program, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->OnRungsChanged();
  });
  CLEAVE_ASSIGN_OR_RETURN(const JournalContents contents, ReadJournal(paths_.journal()));
  const JournalState journal = SummariseJournal(contents.records);
  CLEAVE_RETURN_IF_ERROR(frames_.Refresh(std::numeric_limits<int64_t>::max()));
  rungs_->Committed(frames_.head());
  const std::lock_guard lock(mutex_);
  status_.set_state(journal.failure ? v1::SESSION_STATE_FAILED : v1::SESSION_STATE_IDLE);
  if (journal.failure) *status_.mutable_error() = journal.failure->error();
  status_.set_goal_frame(journal.last_goal_frame);
  status_.set_head_frame(frames_.head());
  if (const std::optional<IndexRow> row = frames_.Find(frames_.head()); row.has_value()) {
    status_.mutable_progress()->set_time(row->time);
    status_.mutable_progress()->set_fragments(row->fragments);
    status_.mutable_progress()->set_broken_edges(static_cast<int64_t>(row->broken_edges));
  }
  return journal.goal.has_value() ? StartWorkerLocked() : absl::OkStatus();
}

HostedSession::State HostedSession::state() const {
  const std::lock_guard lock(mutex_);
  return {status_.state(), status_.head_frame(), Works(status_.state()) || runs_in_flight_ > 0,
          deleted_, status_.error()};
}

v1::Session HostedSession::View(bool with_scene) const {
  v1::Session view;
  view.set_name(name());
  view.set_uid(config_.uid());
  *view.mutable_create_time() = config_.create_time();
  if (with_scene) *view.mutable_scene() = config_.scene();
  const std::lock_guard lock(mutex_);
  view.set_state(status_.state());
  view.set_head_frame(status_.head_frame());
  view.set_goal_frame(status_.goal_frame());
  if (status_.state() == v1::SESSION_STATE_FAILED) *view.mutable_error() = status_.error();
  *view.mutable_progress() = status_.progress();
  view.set_viewer_count(static_cast<uint32_t>(viewers_));
  view.set_rung(config_.rung());
  return view;
}

absl::Status HostedSession::StartWorker() {
  absl::Status status;
  {
    const std::lock_guard lock(mutex_);
    WorkerLocked(status);
  }
  Notify();
  return status;
}

absl::Status HostedSession::StartWorkerLocked() {
  WorkerProcess::Listener listener;
  const std::weak_ptr<HostedSession> weak = weak_from_this();
  listener.on_status = [weak](const worker::v1::Status& status) {
    if (const auto self = weak.lock()) self->OnStatus(status);
  };
  listener.on_exit = [weak](const std::string& how) {
    if (const auto self = weak.lock()) self->OnExit(how);
  };
  const int threads = config_.threads() > 0 ? config_.threads() : options_.threads;
  CLEAVE_ASSIGN_OR_RETURN(
      worker_, WorkerProcess::Start({options_.program, paths_.root, threads}, std::move(listener)));
  start_head_ = status_.head_frame();
  status_.set_state(start_head_ < 0 ? v1::SESSION_STATE_PREPARING : v1::SESSION_STATE_RECOVERING);
  status_.clear_error();
  Log(LogLevel::kInfo, "worker_started",
      {{"session", config_.session_id()}, {"pid", absl::StrCat(worker_->pid())}});
  return absl::OkStatus();
}

std::shared_ptr<WorkerProcess> HostedSession::WorkerLocked(absl::Status& status) {
  if (deleted_) {
    status = MakeError(absl::StatusCode::kNotFound, "SESSION_NOT_FOUND",
                       absl::StrCat(name(), " was deleted"));
  } else if (shutting_down_) {
    status = MakeRetryLater("DRAINING", "the server goes down", 2);
  } else if (worker_ == nullptr) {
    status = WorkerError(StartWorkerLocked());
  }
  return status.ok() ? worker_ : nullptr;
}

void HostedSession::Run(const v1::RunGoal& goal, const std::string& request_id, Done done) {
  absl::Status status;
  std::shared_ptr<WorkerProcess> worker;
  {
    const std::lock_guard lock(mutex_);
    worker = WorkerLocked(status);
    if (worker != nullptr) ++runs_in_flight_;
  }
  if (worker == nullptr) return done(status);
  Notify();
  worker::v1::Command command;
  *command.mutable_run()->mutable_goal() = goal;
  command.mutable_run()->set_request_id(request_id);
  worker->Send(std::move(command), [self = shared_from_this(), goal,
                                    done = std::move(done)](const absl::Status& acknowledged) {
    self->OnRunAcknowledged(goal, acknowledged);
    done(WorkerError(acknowledged));
  });
}

void HostedSession::OnRunAcknowledged(const v1::RunGoal& goal, const absl::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    --runs_in_flight_;
    if (status.ok()) {
      // The worker's own word on it follows; until then nobody shall take the session for resting.
      if (!Works(status_.state()) || status_.state() == v1::SESSION_STATE_PAUSING) {
        status_.set_state(v1::SESSION_STATE_RUNNING);
        status_.clear_error();
      }
      status_.set_goal_frame(goal.until_frame());
    }
  }
  Notify();
}

void HostedSession::Pause(bool abort_step, Done done) {
  std::shared_ptr<WorkerProcess> worker;
  {
    const std::lock_guard lock(mutex_);
    worker = worker_;
  }
  // Without a worker nothing runs: an unfinished goal always has one.
  if (worker == nullptr) return done(absl::OkStatus());
  worker::v1::Command command;
  command.mutable_pause()->set_abort_step(abort_step);
  worker->Send(std::move(command), [self = shared_from_this(),
                                    done = std::move(done)](const absl::Status& acknowledged) {
    if (acknowledged.ok()) {
      const std::lock_guard lock(self->mutex_);
      if (self->status_.state() == v1::SESSION_STATE_RUNNING) {
        self->status_.set_state(v1::SESSION_STATE_PAUSING);
      }
    }
    self->Notify();
    done(WorkerError(acknowledged));
  });
}

void HostedSession::Delete(std::function<void()> removable) {
  rungs_->End(/*at_once=*/true);
  std::shared_ptr<WorkerProcess> worker;
  {
    const std::lock_guard lock(mutex_);
    deleted_ = true;
    worker = worker_;
    if (!EndedLocked()) removable_.swap(removable);
  }
  Notify();
  if (worker != nullptr) worker->Kill();
  if (removable) removable();
}

void HostedSession::Shutdown() {
  std::shared_ptr<WorkerProcess> worker;
  {
    const std::lock_guard lock(mutex_);
    shutting_down_ = true;
    worker = worker_;
  }
  if (worker != nullptr) worker->Quit();
  rungs_->End(/*at_once=*/false);
}

bool HostedSession::WaitForWorkers(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  if (workers_ended_.wait_until(lock, deadline, [this] { return EndedLocked(); })) return true;
  if (worker_ != nullptr) worker_->Kill();
  rungs_->End(/*at_once=*/true);
  return false;
}

void HostedSession::OnStatus(const worker::v1::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    const int64_t head = std::max(status_.head_frame(), status.head_frame());
    const int64_t goal = std::max<int64_t>(status.goal_frame(), 0);
    const v1::Progress progress = status.has_progress() ? status.progress() : status_.progress();
    if (head > start_head_) restarts_ = 0;
    if (status.state() == v1::SESSION_STATE_FAILED && status_.state() != v1::SESSION_STATE_FAILED) {
      Log(LogLevel::kWarning, "session_failed",
          {{"session", config_.session_id()},
           {"reason", status.error().reason()},
           {"message", status.error().message()}});
    }
    status_ = status;
    status_.set_head_frame(head);
    status_.set_goal_frame(goal);
    *status_.mutable_progress() = progress;
  }
  rungs_->Committed(status.head_frame());
  Notify();
}

void HostedSession::OnRungsChanged() {
  std::function<void()> removable;
  {
    const std::lock_guard lock(mutex_);
    if (EndedLocked()) removable.swap(removable_);
    workers_ended_.notify_all();
  }
  Notify();
  if (removable) removable();
}

void HostedSession::OnExit(const std::string& how) {
  std::function<void()> removable;
  {
    const std::lock_guard lock(mutex_);
    worker_.reset();
    workers_ended_.notify_all();
    Log(shutting_down_ || deleted_ ? LogLevel::kInfo : LogLevel::kWarning, "worker_ended",
        {{"session", config_.session_id()},
         {"how", how},
         {"head", absl::StrCat(status_.head_frame())}});
    if (EndedLocked()) removable.swap(removable_);
    if (!deleted_ && !shutting_down_ && Works(status_.state())) {
      absl::Status status = absl::AbortedError("it ended without a new frame too often");
      if (restarts_++ < kMaxRestarts) status = StartWorkerLocked();
      if (!status.ok()) {
        status_.set_state(v1::SESSION_STATE_FAILED);
        v1::Error& error = *status_.mutable_error();
        error.set_reason("WORKER_LOST");
        error.set_message(absl::StrCat("the worker ended with ", how, "; ", status.message()));
        error.set_code(static_cast<int>(absl::StatusCode::kAborted));
        restarts_ = 0;
      }
    }
  }
  Notify();
  if (removable) removable();
}

HostedSession::ObserverId HostedSession::Observe(std::function<void()> changed) {
  const std::lock_guard lock(observers_mutex_);
  observers_.emplace(++last_observer_, std::make_shared<std::function<void()>>(std::move(changed)));
  return last_observer_;
}

void HostedSession::Forget(ObserverId observer) {
  std::shared_ptr<std::function<void()>> dropped;
  const std::lock_guard lock(observers_mutex_);
  const auto entry = observers_.find(observer);
  if (entry == observers_.end()) return;
  dropped = std::move(entry->second);
  observers_.erase(entry);
}

void HostedSession::Notify() {
  std::vector<std::shared_ptr<std::function<void()>>> observers;
  {
    const std::lock_guard lock(observers_mutex_);
    for (const auto& [id, observer] : observers_) observers.push_back(observer);
  }
  for (const auto& observer : observers) (*observer)();
}

void HostedSession::AddViewer(int count) {
  const std::lock_guard lock(mutex_);
  viewers_ += count;
}

}  // namespace cleave
