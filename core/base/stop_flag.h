#ifndef CLEAVE_CORE_BASE_STOP_FLAG_H_
#define CLEAVE_CORE_BASE_STOP_FLAG_H_

#include <atomic>

namespace cleave {

// Asks a computation to give up soon. Set from any thread; the computation looks at it between
// linear-solver iterations and returns Cancelled with its state as before the call.
class StopFlag {
 public:
  void Request() { requested_.store(true, std::memory_order_relaxed); }
  void Clear() { requested_.store(false, std::memory_order_relaxed); }
  bool requested() const { return requested_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> requested_{false};
};

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_STOP_FLAG_H_
