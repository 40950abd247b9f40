#include "server/worker/controller.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/base/status.h"
#include "server/control/message_socket.h"

namespace cleave {

Controller::~Controller() {
  if (!listener_.joinable()) return;
  const uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(wake_.get(), &one, sizeof(one));
  listener_.join();
}

absl::Status Controller::Start(JournalWriter journal, JournalState state) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  signals_ = FileDescriptor(signalfd(-1, &signals, SFD_CLOEXEC));
  wake_ = FileDescriptor(eventfd(0, EFD_CLOEXEC));
  if (!signals_.valid() || !wake_.valid()) {
    return absl::ErrnoToStatus(errno, "cannot listen for signals");
  }
  journal_.emplace(std::move(journal));
  state_ = std::move(state);
  goal_start_ = std::chrono::steady_clock::now();
  status_.set_goal_frame(state_.last_goal_frame);
  listener_ = std::thread([this] { Listen(); });
  return absl::OkStatus();
}

bool Controller::KeepGoing() {
  const std::lock_guard lock(mutex_);
  if (quit_) return false;
  stop_.Clear();
  return true;
}

void Controller::Report(v1::SessionState state, int64_t head) {
  const std::lock_guard lock(mutex_);
  status_.set_state(state);
  status_.set_head_frame(head);
  SendStatus();
}

absl::Status Controller::RunTo(int64_t until_frame) {
  const std::lock_guard lock(mutex_);
  if (state_.goal.has_value()) return absl::OkStatus();
  worker::v1::Command command;
  command.mutable_run()->mutable_goal()->set_until_frame(until_frame);
  return Obey(command);
}

absl::StatusOr<Order> Controller::Take(int64_t head) {
  const std::lock_guard lock(mutex_);
  attention_ = false;
  if (quit_) return Order::kQuit;
  stop_.Clear();
  if (state_.goal.has_value() && GoalReached(head)) {
    worker::v1::JournalRecord record;
    record.mutable_run_ended()->set_frame(head);
    CLEAVE_RETURN_IF_ERROR(Journal(record));
  }
  const bool run = state_.goal.has_value();
  status_.set_head_frame(head);
  if (run) {
    status_.clear_error();
    status_.set_state(v1::SESSION_STATE_RUNNING);
  } else if (state_.failure.has_value()) {
    *status_.mutable_error() = state_.failure->error();
    status_.set_state(v1::SESSION_STATE_FAILED);
  } else {
    status_.set_state(v1::SESSION_STATE_IDLE);
  }
  SendStatus();
  return run ? Order::kAdvance : Order::kRest;
}

void Controller::Wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return attention_; });
}

void Controller::Committed(int64_t head, const v1::Progress& progress, bool broke_edges) {
  const std::lock_guard lock(mutex_);
  goal_broke_edges_ = goal_broke_edges_ || broke_edges;
  status_.set_head_frame(head);
  *status_.mutable_progress() = progress;
}

void Controller::Failed(const v1::Error& error) {
  const std::lock_guard lock(mutex_);
  worker::v1::JournalRecord record;
  record.mutable_run_failed()->set_frame(status_.head_frame());
  *record.mutable_run_failed()->mutable_error() = error;
  // A disk that is full cannot record that it is full; the goal stays in the journal then, and the
  // next worker tries again.
  if (!Journal(record).ok()) state_.Apply(record);
  status_.set_state(v1::SESSION_STATE_FAILED);
  *status_.mutable_error() = error;
  SendStatus();
}

absl::Status Controller::failure() const {
  const std::lock_guard lock(mutex_);
  if (!state_.failure.has_value()) return absl::OkStatus();
  const v1::Error& error = state_.failure->error();
  return {static_cast<absl::StatusCode>(error.code()), error.message()};
}

void Controller::Listen() {
  pollfd watched[3] = {
      {signals_.get(), POLLIN, 0}, {wake_.get(), POLLIN, 0}, {control_.get(), POLLIN, 0}};
  while (true) {
    if (poll(watched, control_.valid() ? 3 : 2, -1) < 0) {
      if (errno == EINTR) continue;
      return Quit();
    }
    if (watched[1].revents != 0) return;
    if (watched[0].revents != 0) {
      Quit();
      watched[0].fd = -1;
    }
    if (!control_.valid() || watched[2].revents == 0) continue;
    worker::v1::Command command;
    if (!ReceiveMessage(control_, command).ok()) return Quit();
    HandleCommand(command);
  }
}

void Controller::HandleCommand(const worker::v1::Command& command) {
  if (command.has_quit()) Quit();
  const std::lock_guard lock(mutex_);
  const absl::Status status = command.has_quit() ? absl::OkStatus() : Obey(command);
  worker::v1::Event event;
  event.mutable_acknowledged()->set_sequence(command.sequence());
  event.mutable_acknowledged()->set_code(static_cast<int>(status.code()));
  event.mutable_acknowledged()->set_message(std::string(status.message()));
  Send(event);
  attention_ = true;
  changed_.notify_all();
}

absl::Status Controller::Obey(const worker::v1::Command& command) {
  worker::v1::JournalRecord record;
  switch (command.command_case()) {
    case worker::v1::Command::kRun: {
      if (state_.run_requests.contains(command.run().request_id())) return absl::OkStatus();
      if (command.run().goal().until_frame() < 1) {
        return absl::InvalidArgumentError("a run needs a frame to run to");
      }
      *record.mutable_run() = command.run();
      CLEAVE_RETURN_IF_ERROR(Journal(record));
      goal_start_ = std::chrono::steady_clock::now();
      goal_broke_edges_ = false;
      status_.set_goal_frame(state_.last_goal_frame);
      return absl::OkStatus();
    }
    case worker::v1::Command::kPause:
      if (state_.goal.has_value()) {
        *record.mutable_pause() = command.pause();
        CLEAVE_RETURN_IF_ERROR(Journal(record));
      }
      if (command.pause().abort_step()) stop_.Request();
      return absl::OkStatus();
    default:
      return absl::UnimplementedError("the worker does not know this command");
  }
}

absl::Status Controller::Journal(const worker::v1::JournalRecord& record) {
  CLEAVE_RETURN_IF_ERROR(journal_->Append(record));
  state_.Apply(record);
  return absl::OkStatus();
}

bool Controller::GoalReached(int64_t head) const {
  const v1::RunGoal& goal = state_.goal->goal();
  if (head >= goal.until_frame()) return true;
  if (goal.stop_on_fracture() && goal_broke_edges_) return true;
  if (!goal.has_wall_budget()) return false;
  const std::chrono::duration<double> budget(static_cast<double>(goal.wall_budget().seconds()) +
                                             1e-9 * goal.wall_budget().nanos());
  return std::chrono::steady_clock::now() - goal_start_ >= budget;
}

void Controller::SendStatus() {
  worker::v1::Event event;
  *event.mutable_status() = status_;
  Send(event);
}

void Controller::Send(const worker::v1::Event& event) {
  // A gateway that is gone shows as the end of the socket, which the listener obeys.
  if (control_.valid()) SendMessage(control_, event).IgnoreError();
}

void Controller::Quit() {
  const std::lock_guard lock(mutex_);
  quit_ = true;
  attention_ = true;
  stop_.Request();
  changed_.notify_all();
}

}  // namespace cleave
