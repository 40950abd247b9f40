#ifndef CLEAVE_CLIENT_CPP_CALL_WITH_RETRY_H_
#define CLEAVE_CLIENT_CPP_CALL_WITH_RETRY_H_

#include <grpcpp/client_context.h>

#include <functional>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "client/cpp/retry.h"
#include "core/base/stop_flag.h"

namespace cleave {

// Runs `call` with a fresh context until it succeeds, fails for good or the attempts are used up.
// `words` names the call for messages. `stop` may be null.
absl::Status CallWithRetry(const RetryPolicy& policy, absl::string_view words, const StopFlag* stop,
                           const std::function<grpc::Status(grpc::ClientContext&)>& call);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_CALL_WITH_RETRY_H_
