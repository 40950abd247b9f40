#ifndef CLEAVE_SERVER_WORKER_FAILURE_H_
#define CLEAVE_SERVER_WORKER_FAILURE_H_

#include "absl/status/status.h"
#include "cleave/v1/session.pb.h"

namespace cleave {

// What clients are told when a session fails with this status.
v1::Error FailureOf(const absl::Status& status);

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_FAILURE_H_
