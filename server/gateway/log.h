#ifndef CLEAVE_SERVER_GATEWAY_LOG_H_
#define CLEAVE_SERVER_GATEWAY_LOG_H_

#include <initializer_list>
#include <string>
#include <utility>

#include "absl/strings/string_view.h"

namespace cleave {

enum class LogLevel { kInfo, kWarning, kError };

// Writes one line to stderr: time (UTC), level, event, then key=value pairs. Values with blanks are
// quoted. Thread-safe.
void Log(LogLevel level, absl::string_view event,
         std::initializer_list<std::pair<absl::string_view, std::string>> fields = {});

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_LOG_H_
