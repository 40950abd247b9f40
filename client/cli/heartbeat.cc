#include "client/cli/heartbeat.h"

#include <utility>

namespace cleave {

Heartbeat::Heartbeat(std::chrono::milliseconds period, Tell tell)
    : period_(period), tell_(std::move(tell)), thread_([this] { Beat(); }) {}

Heartbeat::~Heartbeat() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  end_.notify_one();
  thread_.join();
}

void Heartbeat::Beat() {
  std::unique_lock lock(mutex_);
  while (!end_.wait_for(lock, period_, [this] { return ended_; })) tell_(watch_.Seconds());
}

}  // namespace cleave
