#ifndef CLEAVE_CLIENT_CLI_HEARTBEAT_H_
#define CLEAVE_CLIENT_CLI_HEARTBEAT_H_

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "core/base/stopwatch.h"

namespace cleave {

// For work that cannot say how far it is: tells how long it has been going on, once a period, on a
// thread of its own, until it ends.
class Heartbeat {
 public:
  using Tell = std::function<void(double seconds)>;

  Heartbeat(std::chrono::milliseconds period, Tell tell);
  ~Heartbeat();  // `tell` does not run any more when it returns
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

 private:
  void Beat();

  const std::chrono::milliseconds period_;
  const Tell tell_;
  const Stopwatch watch_;
  std::mutex mutex_;  // guards ended_
  std::condition_variable end_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_HEARTBEAT_H_
