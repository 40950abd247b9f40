#ifndef CLEAVE_SERVER_GATEWAY_EXECUTOR_H_
#define CLEAVE_SERVER_GATEWAY_EXECUTOR_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace cleave {

// The gateway's own threads: everything that may wait for a disk or takes long runs here, because
// RPC handlers share two threads with the health check. Thread-safe.
class Executor {
 public:
  using Clock = std::chrono::steady_clock;
  using TimerId = uint64_t;

  explicit Executor(int threads);
  // Drops what is queued and waits for what runs.
  ~Executor();

  void Submit(std::function<void()> task);
  // Submits the task at `time`.
  TimerId SubmitAt(Clock::time_point time, std::function<void()> task);
  // A timer that has fired, or never was, is fine.
  void Cancel(TimerId timer);

 private:
  void Work();
  void WatchTimers();

  std::mutex mutex_;
  std::condition_variable work_ready_;
  std::condition_variable timers_changed_;
  std::deque<std::function<void()>> queue_;
  std::map<std::pair<Clock::time_point, TimerId>, std::function<void()>> timers_;
  std::map<TimerId, Clock::time_point> timer_times_;
  TimerId last_timer_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

// Runs one task, never twice at once: a Wake while it runs makes it run once more afterwards.
// `owner` keeps alive whatever the task touches, this pump included. Thread-safe.
class Pump {
 public:
  Pump(Executor& executor, std::function<void()> task)
      : executor_(executor), task_(std::move(task)) {}

  void Wake(const std::shared_ptr<void>& owner);

 private:
  void Run(const std::shared_ptr<void>& owner);

  Executor& executor_;
  const std::function<void()> task_;
  std::mutex mutex_;
  bool running_ = false;
  bool again_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_EXECUTOR_H_
