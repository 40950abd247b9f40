#include "client/cli/exit_code.h"

#include <csignal>

#include "absl/strings/cord.h"

namespace cleave {
namespace {

constexpr char kFailedPayload[] = "cleave/simulation-failed";

}  // namespace

absl::Status SimulationFailed(absl::string_view message) {
  absl::Status status = absl::AbortedError(message);
  status.SetPayload(kFailedPayload, absl::Cord());
  return status;
}

ExitCode ExitCodeOf(const absl::Status& status, int signal) {
  if (status.GetPayload(kFailedPayload).has_value()) return ExitCode::kSimulationFailed;
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return ExitCode::kOk;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kOutOfRange:
    case absl::StatusCode::kDataLoss:
      return ExitCode::kInvalidInput;
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
      return ExitCode::kUnreachable;
    case absl::StatusCode::kNotFound:
      return ExitCode::kNotFound;
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kAlreadyExists:
    case absl::StatusCode::kAborted:
      return ExitCode::kState;
    case absl::StatusCode::kResourceExhausted:
      return ExitCode::kLimit;
    case absl::StatusCode::kCancelled:
      return signal == SIGTERM ? ExitCode::kTerminated : ExitCode::kInterrupted;
    default:
      return ExitCode::kOther;
  }
}

std::string ExitCodeHelp() {
  return "Exit codes:\n"
         "  0    done\n"
         "  1    something else went wrong (a file could not be written, ...)\n"
         "  2    the command line is wrong\n"
         "  3    the scene, the mesh or a value is invalid, every fault a line on stderr; or a "
         "file\n"
         "       is damaged\n"
         "  4    no server answers\n"
         "  5    the simulation failed; the frames so far are safe\n"
         "  6    no such file or session\n"
         "  7    the session or the folder is not in a state for this\n"
         "  8    a limit of the server, or the disk is full\n"
         "  130  interrupted (Ctrl-C); 143: terminated\n";
}

}  // namespace cleave
