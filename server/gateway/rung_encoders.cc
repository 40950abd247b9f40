#include "server/gateway/rung_encoders.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "server/gateway/log.h"
#include "server/session/encoding.h"

namespace cleave {
namespace {

// A worker that ends this often without encoding a frame in between ends the same way again.
constexpr int kMaxRestarts = 3;

}  // namespace

RungEncoders::RungEncoders(SessionPaths paths, std::string program, std::function<void()> changed)
    : paths_(std::move(paths)), program_(std::move(program)), changed_(std::move(changed)) {
  std::error_code error;  // where there are no rungs, or one cannot be removed, nothing is lost
  for (const auto& entry : std::filesystem::directory_iterator(paths_.rungs(), error)) {
    std::error_code removing;
    if (absl::StartsWith(entry.path().filename().string(), kRegionPrefix))
      std::filesystem::remove_all(entry.path(), removing);
  }
}

FrameLogReader& RungEncoders::frames(const std::string& name) {
  const std::lock_guard lock(mutex_);
  return encoders_.at(name).frames;
}

RungEncoders::State RungEncoders::state(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const Encoder& encoder = encoders_.at(name);
  return {encoder.head, encoder.failure};
}

// Where regions take all places, the one that was left first gives up its own.
absl::Status RungEncoders::MakeRoomLocked() {
  size_t regions = 0;
  bool some_leave = false;
  auto idle = encoders_.end();
  for (auto at = encoders_.begin(); at != encoders_.end(); ++at) {
    const Encoder& encoder = at->second;
    if (!encoder.encoding.has_region()) continue;
    ++regions;
    some_leave |= encoder.viewers == 0;
    if (encoder.viewers > 0 || encoder.worker != nullptr) continue;
    if (idle == encoders_.end() || encoder.left < idle->second.left) idle = at;
  }
  if (regions < kMaxRegions) return absl::OkStatus();
  if (idle == encoders_.end() && some_leave) {
    return absl::UnavailableError("the place of a region is about to be free");
  }
  if (idle == encoders_.end()) {
    return absl::ResourceExhaustedError(
        absl::StrCat("other viewers look at ", kMaxRegions, " regions already"));
  }
  std::error_code error;
  std::filesystem::remove_all(paths_.rung(idle->first), error);
  std::filesystem::remove(paths_.rung_owner(idle->first), error);
  encoders_.erase(idle);
  return absl::OkStatus();
}

void RungEncoders::StartLocked(Encoder& encoder) {
  const std::string name = encoder.encoding.name();
  WorkerProcess::Listener listener;
  const std::weak_ptr<RungEncoders> weak = weak_from_this();
  listener.on_status = [weak, name](const worker::v1::Status& status) {
    if (const auto self = weak.lock()) self->OnStatus(name, status);
  };
  listener.on_exit = [weak, name](const std::string& how) {
    if (const auto self = weak.lock()) self->OnExit(name, how);
  };
  absl::StatusOr<std::shared_ptr<WorkerProcess>> worker = WorkerProcess::Start(
      {.program = program_, .directory = paths_.root, .threads = 1, .encoding = encoder.encoding},
      std::move(listener));
  encoder.failure = worker.status();
  if (!worker.ok()) return;
  encoder.worker = *std::move(worker);
  encoder.told = -1;
  encoder.start_head = encoder.head;
  Log(LogLevel::kInfo, "rung_worker_started",
      {{"directory", paths_.root}, {"rung", name}, {"pid", absl::StrCat(encoder.worker->pid())}});
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

absl::Status RungEncoders::AddViewer(const worker::v1::Encoding& encoding) {
  const std::lock_guard lock(mutex_);
  if (encoding.has_region() && !encoders_.contains(encoding.name()))
    CLEAVE_RETURN_IF_ERROR(MakeRoomLocked());
  Encoder& encoder =
      encoders_.try_emplace(encoding.name(), encoding, paths_.rung(encoding.name())).first->second;
  if (++encoder.viewers == 1) encoder.restarts = 0;
  // One that is on its way out is replaced when it has ended.
  if (encoder.worker == nullptr && !ending_) StartLocked(encoder);
  return absl::OkStatus();
}

void RungEncoders::RemoveViewer(const std::string& name) {
  const std::lock_guard lock(mutex_);
  Encoder& encoder = encoders_.at(name);
  if (--encoder.viewers == 0) encoder.left = ++leaves_;
  if (encoder.viewers > 0 || encoder.worker == nullptr) return;
  encoder.quitting = true;
  encoder.worker->Quit();
}

void RungEncoders::Committed(int64_t head) {
  const std::lock_guard lock(mutex_);
  session_head_ = std::max(session_head_, head);
  for (auto& [name, encoder] : encoders_) TellLocked(encoder);
}

void RungEncoders::End(bool at_once) {
  const std::lock_guard lock(mutex_);
  ending_ = true;
  for (auto& [name, encoder] : encoders_) {
    if (encoder.worker == nullptr) continue;
    at_once ? encoder.worker->Kill() : encoder.worker->Quit();
  }
}

bool RungEncoders::ended() const {
  const std::lock_guard lock(mutex_);
  return std::all_of(encoders_.begin(), encoders_.end(),
                     [](const auto& entry) { return entry.second.worker == nullptr; });
}

void RungEncoders::OnStatus(const std::string& name, const worker::v1::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    Encoder& encoder = encoders_.at(name);
    if (status.has_error()) {
      encoder.failure = absl::Status(static_cast<absl::StatusCode>(status.error().code()),
                                     status.error().message());
      Log(LogLevel::kError, "rung_failed",
          {{"directory", paths_.root}, {"rung", name}, {"reason", status.error().message()}});
    } else {
      encoder.head = status.head_frame();
      if (encoder.head > encoder.start_head) encoder.restarts = 0;
      TellLocked(encoder);
    }
  }
  changed_();
}

void RungEncoders::OnExit(const std::string& name, const std::string& how) {
  {
    const std::lock_guard lock(mutex_);
    Encoder& encoder = encoders_.at(name);
    encoder.worker.reset();
    const bool told_to = std::exchange(encoder.quitting, false);
    Log(told_to || ending_ ? LogLevel::kInfo : LogLevel::kWarning, "rung_worker_ended",
        {{"directory", paths_.root}, {"rung", name}, {"how", how}});
    if (encoder.viewers > 0 && !ending_ && encoder.failure.ok()) {
      if (told_to || encoder.restarts++ < kMaxRestarts) {
        StartLocked(encoder);
      } else {
        encoder.failure = absl::AbortedError(
            absl::StrCat("its worker ended with ", how, " too often without a new frame"));
      }
    }
  }
  changed_();
}

}  // namespace cleave
