#ifndef CLEAVE_CLIENT_CLI_BOUNDED_STOP_H_
#define CLEAVE_CLIENT_CLI_BOUNDED_STOP_H_

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "client/cli/interrupt.h"

namespace cleave {

// For work that stops between its items and whose files are whole or aside at any time: a signal
// requests a stop, and where none has come about within `patience`, the program ends as a stopped
// one does. Not thread-safe; one at a time.
class BoundedStop {
 public:
  explicit BoundedStop(Interrupt& interrupt,
                       std::chrono::milliseconds patience = std::chrono::seconds(5));
  ~BoundedStop();
  BoundedStop(const BoundedStop&) = delete;
  BoundedStop& operator=(const BoundedStop&) = delete;

 private:
  Interrupt& interrupt_;
  const std::chrono::milliseconds patience_;
  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_BOUNDED_STOP_H_
