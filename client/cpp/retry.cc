#include "client/cpp/retry.h"

#include <algorithm>
#include <cstdint>
#include <thread>

#include "client/cpp/rpc_error.h"

namespace cleave {

using std::chrono::milliseconds;

std::optional<milliseconds> RetryDelay(const RetryPolicy& policy, int attempt,
                                       const absl::Status& status) {
  if (status.ok() || attempt >= policy.max_attempts) return std::nullopt;
  if (absl::IsResourceExhausted(status)) return RetryDelayOf(status);
  if (!absl::IsUnavailable(status)) return std::nullopt;
  if (const auto wanted = RetryDelayOf(status)) return wanted;
  const int doublings = std::min(attempt - 1, 20);
  return std::min(policy.max_delay, policy.first_delay * (int64_t{1} << doublings));
}

bool WaitUnlessStopped(milliseconds delay, const StopFlag* stop) {
  constexpr milliseconds kLook{50};
  const auto end = std::chrono::steady_clock::now() + delay;
  while (stop == nullptr || !stop->requested()) {
    const auto left = end - std::chrono::steady_clock::now();
    if (left <= milliseconds(0)) return true;
    std::this_thread::sleep_for(std::min<std::chrono::steady_clock::duration>(left, kLook));
  }
  return false;
}

}  // namespace cleave
