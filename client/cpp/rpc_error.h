#ifndef CLEAVE_CLIENT_CPP_RPC_ERROR_H_
#define CLEAVE_CLIENT_CPP_RPC_ERROR_H_

#include <grpcpp/support/status.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/base/faults.h"

namespace cleave {

// What a call answered, for people and programs: the code is gRPC's, the message is readable lines
// (one a fault where the server named fields), and the details stay readable by the functions
// below. `call` names the call in words, for example "creating the session".
absl::Status StatusFromRpc(const grpc::Status& status, absl::string_view call);

// The faults by field that an answer carried (google.rpc.BadRequest). Fields are paths in the
// scene: the request's own prefix "scene." is gone.
std::vector<Fault> FaultsOf(const absl::Status& status);

// The constant that names the reason (google.rpc.ErrorInfo), empty if there is none.
std::string ReasonOf(const absl::Status& status);

// When the server asks to be tried again (google.rpc.RetryInfo).
std::optional<std::chrono::milliseconds> RetryDelayOf(const absl::Status& status);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_RPC_ERROR_H_
