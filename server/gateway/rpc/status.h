#ifndef CLEAVE_SERVER_GATEWAY_RPC_STATUS_H_
#define CLEAVE_SERVER_GATEWAY_RPC_STATUS_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace cleave {

// The answer of a call: the status's payloads become google.rpc details in the trailer
// grpc-status-details-bin. A status without an ErrorInfo gets one that names its code.
grpc::Status ToRpcStatus(const absl::Status& status);

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_STATUS_H_
