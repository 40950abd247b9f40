#ifndef CLEAVE_CLIENT_CPP_RETRY_H_
#define CLEAVE_CLIENT_CPP_RETRY_H_

#include <chrono>
#include <optional>

#include "absl/status/status.h"
#include "core/base/stop_flag.h"

namespace cleave {

// How calls are repeated. Every call that goes through it must be safe to repeat: ours are, by
// request ids, expected heads and names.
struct RetryPolicy {
  int max_attempts = 8;
  std::chrono::milliseconds first_delay{200};
  std::chrono::milliseconds max_delay{5000};
  std::chrono::milliseconds call_deadline{30000};  // of each attempt
};

// How long to wait before attempt `attempt` + 1 (attempts count from 1) after `status`; nullopt: do
// not try again. Only Unavailable is tried again blindly, with doubling delays; ResourceExhausted
// only where the server says when.
std::optional<std::chrono::milliseconds> RetryDelay(const RetryPolicy& policy, int attempt,
                                                    const absl::Status& status);

// Waits; answers false at once when `stop` is requested (looked at every 50 ms).
bool WaitUnlessStopped(std::chrono::milliseconds delay, const StopFlag* stop);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_RETRY_H_
