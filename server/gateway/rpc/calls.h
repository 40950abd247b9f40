#ifndef CLEAVE_SERVER_GATEWAY_RPC_CALLS_H_
#define CLEAVE_SERVER_GATEWAY_RPC_CALLS_H_

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "server/gateway/executor.h"
#include "server/gateway/rpc/status.h"

namespace cleave {

// Answers a unary call from the executor, so that its handler returns at once.
inline grpc::ServerUnaryReactor* AnswerFrom(Executor& executor,
                                            grpc::CallbackServerContext* context,
                                            std::function<absl::Status()> work) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  executor.Submit([reactor, work = std::move(work)] { reactor->Finish(ToRpcStatus(work())); });
  return reactor;
}

// When a call that may take long should answer to be in time for its deadline; none without one.
inline std::optional<Executor::Clock::time_point> AnswerTime(
    const grpc::CallbackServerContext& context) {
  using std::chrono::milliseconds;
  const auto deadline = context.deadline();
  if (deadline == std::chrono::system_clock::time_point::max()) return std::nullopt;
  const auto left =
      std::chrono::duration_cast<milliseconds>(deadline - std::chrono::system_clock::now());
  // A deadline centuries away would overflow the other clock.
  if (left > std::chrono::hours(24 * 365)) return std::nullopt;
  const milliseconds margin = std::clamp(left / 10, milliseconds(10), milliseconds(100));
  return Executor::Clock::now() + left - margin;
}

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_CALLS_H_
