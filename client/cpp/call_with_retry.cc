#include "client/cpp/call_with_retry.h"

#include <chrono>
#include <optional>

#include "absl/strings/str_cat.h"
#include "client/cpp/rpc_error.h"

namespace cleave {

absl::Status CallWithRetry(const RetryPolicy& policy, absl::string_view words, const StopFlag* stop,
                           const std::function<grpc::Status(grpc::ClientContext&)>& call) {
  for (int attempt = 1;; ++attempt) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + policy.call_deadline);
    const absl::Status status = StatusFromRpc(call(context), words);
    const std::optional<std::chrono::milliseconds> delay = RetryDelay(policy, attempt, status);
    if (!delay.has_value()) return status;
    if (!WaitUnlessStopped(*delay, stop))
      return absl::CancelledError(absl::StrCat(words, ": stopped while waiting for the server"));
  }
}

}  // namespace cleave
