#ifndef CLEAVE_CLIENT_CLI_INTERRUPT_H_
#define CLEAVE_CLIENT_CLI_INTERRUPT_H_

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "core/base/stop_flag.h"

namespace cleave {

// Turns SIGINT, SIGTERM and SIGHUP into ordinary calls on a thread of its own. Make one in main,
// before any other thread: the signals are blocked for all threads that follow. Thread-safe.
//
// A signal that finds no handler requests a stop. Work that does not end by itself within
// `patience`, as between two looks at stop(), or before a second signal is cut off: the program
// ends as a stopped one does. Files stand it, whole or aside at any time.
class Interrupt {
 public:
  // Told the signal and how many have come since the handler was set, from 1. Runs on the
  // interrupt's thread; may block.
  using Handler = std::function<void(int signal, int count)>;

  explicit Interrupt(std::chrono::milliseconds patience = std::chrono::seconds(5));
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // Requested by signals that find no handler, and by the third in a row in any case.
  StopFlag& stop() { return stop_; }
  // The last signal, 0 for none.
  int signal() const { return signal_.load(); }

  // Replaces the handler; when it returns, the one before does not run any more. Empty: none.
  void SetHandler(Handler handler);

 private:
  using Clock = std::chrono::steady_clock;

  void Wait();
  // Of those watched; 0 when `patience_` is over.
  int NextSignal() const;
  void Take(int number);

  const std::chrono::milliseconds patience_;
  std::optional<Clock::time_point> deadline_;  // of the interrupt's thread
  StopFlag stop_;
  std::atomic<int> signal_{0};
  std::atomic<bool> ending_{false};
  std::mutex mutex_;  // guards handler_ and count_, and is held while the handler runs
  Handler handler_;
  int count_ = 0;
  std::thread thread_;
};

// Sets a handler for as long as it lives.
class ScopedHandler {
 public:
  ScopedHandler(Interrupt& interrupt, Interrupt::Handler handler) : interrupt_(interrupt) {
    interrupt_.SetHandler(std::move(handler));
  }
  ~ScopedHandler() { interrupt_.SetHandler(nullptr); }
  ScopedHandler(const ScopedHandler&) = delete;
  ScopedHandler& operator=(const ScopedHandler&) = delete;

 private:
  Interrupt& interrupt_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_INTERRUPT_H_
