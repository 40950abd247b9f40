#ifndef CLEAVE_SERVER_GATEWAY_DRAIN_H_
#define CLEAVE_SERVER_GATEWAY_DRAIN_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace cleave {

// Calls that stay open until something ends them, and the order to end them all. Thread-safe.
class Drain {
 public:
  using CallId = uint64_t;

  // `end` is told once, from any thread, that the server goes down; it must return at once.
  CallId Enter(std::function<void()> end) {
    const std::lock_guard lock(mutex_);
    calls_.emplace(++last_call_, std::move(end));
    return last_call_;
  }
  void Leave(CallId call) {
    const std::lock_guard lock(mutex_);
    calls_.erase(call);
    if (calls_.empty()) empty_.notify_all();
  }

  bool begun() const {
    const std::lock_guard lock(mutex_);
    return begun_;
  }
  void Begin() {
    std::vector<std::function<void()>> ends;
    {
      const std::lock_guard lock(mutex_);
      begun_ = true;
      for (const auto& [call, end] : calls_) ends.push_back(end);
    }
    for (const auto& end : ends) end();
  }
  // Waits until no call is open; false when some are after `timeout`.
  bool WaitUntilEmpty(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    return empty_.wait_for(lock, timeout, [this] { return calls_.empty(); });
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable empty_;
  std::map<CallId, std::function<void()>> calls_;
  CallId last_call_ = 0;
  bool begun_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_DRAIN_H_
