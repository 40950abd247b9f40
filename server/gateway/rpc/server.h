#ifndef CLEAVE_SERVER_GATEWAY_RPC_SERVER_H_
#define CLEAVE_SERVER_GATEWAY_RPC_SERVER_H_

#include <string>

#include "absl/status/status.h"
#include "server/gateway/options.h"

namespace cleave {

// Serves until SIGTERM or SIGINT, which must be blocked in the whole process beforehand; then ends
// streams cleanly and lets workers save. Errors: what keeps the server from starting.
absl::Status Serve(const GatewayOptions& options);

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_SERVER_H_
