#include "server/gateway/rung_encoders.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/gateway/log.h"

namespace cleave {
namespace {

// A worker that ends this often without encoding a frame in between ends the same way again.
constexpr int kMaxRestarts = 3;

}  // namespace

RungEncoders::RungEncoders(SessionPaths paths, std::string program, std::function<void()> changed)
    : paths_(std::move(paths)), program_(std::move(program)), changed_(std::move(changed)) {
  for (const Rung rung : kRungs) encoders_.try_emplace(rung, paths_.rung(rung));
}

RungEncoders::State RungEncoders::state(Rung rung) const {
  const std::lock_guard lock(mutex_);
  const Encoder& encoder = encoders_.at(rung);
  return {encoder.head, encoder.failure};
}

void RungEncoders::StartLocked(Rung rung, Encoder& encoder) {
  WorkerProcess::Listener listener;
  const std::weak_ptr<RungEncoders> weak = weak_from_this();
  listener.on_status = [weak, rung](const worker::v1::Status& status) {
    if (const auto self = weak.lock()) self->OnStatus(rung, status);
  };
  listener.on_exit = [weak, rung](const std::string& how) {
    if (const auto self = weak.lock()) self->OnExit(rung, how);
  };
  absl::StatusOr<std::shared_ptr<WorkerProcess>> worker = WorkerProcess::Start(
      {.program = program_, .directory = paths_.root, .threads = 1, .rung = rung},
      std::move(listener));
  encoder.failure = worker.status();
  if (!worker.ok()) return;
  encoder.worker = *std::move(worker);
  encoder.told = -1;
  encoder.start_head = encoder.head;
  Log(LogLevel::kInfo, "rung_worker_started",
      {{"directory", paths_.root},
       {"rung", std::string(RungName(rung))},
       {"pid", absl::StrCat(encoder.worker->pid())}});
}

void RungEncoders::TellLocked(Encoder& encoder) {
  // One that is still at what it knows of is told when it is through: its socket never fills.
  if (encoder.worker == nullptr || encoder.head < encoder.told || session_head_ <= encoder.told)
    return;
  encoder.told = session_head_;
  worker::v1::Command command;
  command.mutable_follow()->set_head_frame(session_head_);
  encoder.worker->Send(std::move(command), [](const absl::Status&) {});
}

void RungEncoders::AddViewer(Rung rung) {
  const std::lock_guard lock(mutex_);
  Encoder& encoder = encoders_.at(rung);
  if (++encoder.viewers == 1) encoder.restarts = 0;
  // One that is on its way out is replaced when it has ended.
  if (encoder.worker == nullptr && !ending_) StartLocked(rung, encoder);
}

void RungEncoders::RemoveViewer(Rung rung) {
  const std::lock_guard lock(mutex_);
  Encoder& encoder = encoders_.at(rung);
  if (--encoder.viewers > 0 || encoder.worker == nullptr) return;
  encoder.quitting = true;
  encoder.worker->Quit();
}

void RungEncoders::Committed(int64_t head) {
  const std::lock_guard lock(mutex_);
  session_head_ = std::max(session_head_, head);
  for (auto& [rung, encoder] : encoders_) TellLocked(encoder);
}

void RungEncoders::End(bool at_once) {
  const std::lock_guard lock(mutex_);
  ending_ = true;
  for (auto& [rung, encoder] : encoders_) {
    if (encoder.worker == nullptr) continue;
    at_once ? encoder.worker->Kill() : encoder.worker->Quit();
  }
}

bool RungEncoders::ended() const {
  const std::lock_guard lock(mutex_);
  return std::all_of(encoders_.begin(), encoders_.end(),
                     [](const auto& entry) { return entry.second.worker == nullptr; });
}

void RungEncoders::OnStatus(Rung rung, const worker::v1::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    Encoder& encoder = encoders_.at(rung);
    if (status.has_error()) {
      encoder.failure = absl::Status(static_cast<absl::StatusCode>(status.error().code()),
                                     status.error().message());
      Log(LogLevel::kError, "rung_failed",
          {{"directory", paths_.root},
           {"rung", std::string(RungName(rung))},
           {"reason", status.error().message()}});
    } else {
      encoder.head = status.head_frame();
      if (encoder.head > encoder.start_head) encoder.restarts = 0;
      TellLocked(encoder);
    }
  }
  changed_();
}

void RungEncoders::OnExit(Rung rung, const std::string& how) {
  {
    const std::lock_guard lock(mutex_);
    Encoder& encoder = encoders_.at(rung);
    encoder.worker.reset();
    const bool told_to = std::exchange(encoder.quitting, false);
    Log(told_to || ending_ ? LogLevel::kInfo : LogLevel::kWarning, "rung_worker_ended",
        {{"directory", paths_.root}, {"rung", std::string(RungName(rung))}, {"how", how}});
    if (encoder.viewers > 0 && !ending_ && encoder.failure.ok()) {
      if (told_to || encoder.restarts++ < kMaxRestarts) {
        StartLocked(rung, encoder);
      } else {
        encoder.failure = absl::AbortedError(
            absl::StrCat("its worker ended with ", how, " too often without a new frame"));
      }
    }
  }
  changed_();
}

}  // namespace cleave
