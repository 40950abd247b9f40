#include "server/gateway/executor.h"

namespace cleave {

Executor::Executor(int threads) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { Work(); });
  threads_.emplace_back([this] { WatchTimers(); });
}

Executor::~Executor() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_ready_.notify_all();
  timers_changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Executor::Submit(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(task));
  }
  work_ready_.notify_one();
}

Executor::TimerId Executor::SubmitAt(Clock::time_point time, std::function<void()> task) {
  const std::lock_guard lock(mutex_);
  const TimerId timer = ++last_timer_;
  timers_.emplace(std::make_pair(time, timer), std::move(task));
  timer_times_.emplace(timer, time);
  timers_changed_.notify_one();
  return timer;
}

void Executor::Cancel(TimerId timer) {
  // Destroyed after the lock is given back: the task may own the last reference to something whose
  // destructor comes back here.
  std::function<void()> dropped;
  const std::lock_guard lock(mutex_);
  const auto time = timer_times_.find(timer);
  if (time == timer_times_.end()) return;
  const auto entry = timers_.find({time->second, timer});
  dropped = std::move(entry->second);
  timers_.erase(entry);
  timer_times_.erase(time);
}

void Executor::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    work_ready_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
    if (stopping_) return;
    std::function<void()> task = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    task();
    task = nullptr;
    lock.lock();
  }
}

void Executor::WatchTimers() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (timers_.empty()) {
      timers_changed_.wait(lock);
      continue;
    }
    const auto next = timers_.begin();
    if (const Clock::time_point time = next->first.first; time > Clock::now()) {
      timers_changed_.wait_until(lock, time);
      continue;
    }
    queue_.push_back(std::move(next->second));
    timer_times_.erase(next->first.second);
    timers_.erase(next);
    work_ready_.notify_one();
  }
}

void Pump::Wake(const std::shared_ptr<void>& owner) {
  {
    const std::lock_guard lock(mutex_);
    if (running_) {
      again_ = true;
      return;
    }
    running_ = true;
  }
  executor_.Submit([this, owner] { Run(owner); });
}

void Pump::Run(const std::shared_ptr<void>& owner) {
  task_();
  {
    const std::lock_guard lock(mutex_);
    if (!again_) {
      running_ = false;
      return;
    }
    again_ = false;
  }
  // Through the queue again, so that one busy stream does not hold a thread.
  executor_.Submit([this, owner] { Run(owner); });
}

}  // namespace cleave
