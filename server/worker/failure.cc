#include "server/worker/failure.h"

#include <string>

namespace cleave {
namespace {

const char* ReasonOf(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kAborted:     // no step converges
    case absl::StatusCode::kOutOfRange:  // a node flew beyond what a frame can hold
      return "SOLVER_DIVERGED";
    case absl::StatusCode::kResourceExhausted:
      return "DISK_FULL";
    case absl::StatusCode::kDataLoss:
    case absl::StatusCode::kNotFound:
      return "SESSION_DAMAGED";
    case absl::StatusCode::kInvalidArgument:
      return "SCENE_INVALID";
    default:
      return "INTERNAL";
  }
}

}  // namespace

v1::Error FailureOf(const absl::Status& status) {
  v1::Error error;
  error.set_reason(ReasonOf(status.code()));
  error.set_message(std::string(status.message()));
  error.set_code(static_cast<int>(status.code()));
  return error;
}

}  // namespace cleave
