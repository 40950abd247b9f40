#ifndef CLEAVE_CLIENT_CLI_CONSOLE_H_
#define CLEAVE_CLIENT_CLI_CONSOLE_H_

#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/base/faults.h"

namespace cleave {

// Results: a line on stdout, flushed.
void PrintResult(absl::string_view line);
// Everything else: a line on stderr.
void PrintNote(absl::string_view line);
void PrintWarnings(const std::vector<Fault>& warnings);
// Every line of the message, one fault a line, on stderr.
void PrintError(const absl::Status& status);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_CONSOLE_H_
