#ifndef CLEAVE_CORE_BASE_STOPWATCH_H_
#define CLEAVE_CORE_BASE_STOPWATCH_H_

#include <chrono>

namespace cleave {

// Elapsed seconds, for reports only: no result may depend on it.
class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Adds the time until the end of the scope to `total`.
class ScopedTimer {
 public:
  explicit ScopedTimer(double& total) : total_(total) {}
  ~ScopedTimer() { total_ += watch_.Seconds(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double& total_;
  Stopwatch watch_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_STOPWATCH_H_
