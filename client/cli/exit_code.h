#ifndef CLEAVE_CLIENT_CLI_EXIT_CODE_H_
#define CLEAVE_CLIENT_CLI_EXIT_CODE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cleave {

// What `cleave` ends with; scripts may rely on these numbers. Listed by `cleave --help`.
enum class ExitCode {
  kOk = 0,
  kOther = 1,             // a file could not be written, a bug
  kUsage = 2,             // the command line
  kInvalidInput = 3,      // scene, mesh or a value in them; a damaged file
  kUnreachable = 4,       // no server answers, or it went away for good
  kSimulationFailed = 5,  // the run cannot go on; its frames so far are safe
  kNotFound = 6,          // no such file or session
  kState = 7,             // the session or folder is not in a state for this
  kLimit = 8,             // a limit of the server, or the disk is full
  kInterrupted = 130,     // Ctrl-C
  kTerminated = 143,      // SIGTERM
};

// The status for a session that failed; only it maps to kSimulationFailed.
absl::Status SimulationFailed(absl::string_view message);

// `signal` is the one that was received, 0 for none: it tells kInterrupted from kTerminated.
ExitCode ExitCodeOf(const absl::Status& status, int signal);

// The table for the help text.
std::string ExitCodeHelp();

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_EXIT_CODE_H_
