#include "client/cli/console.h"

#include <cstdio>
#include <string>

#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

void Print(std::FILE* stream, absl::string_view line) {
  const std::string text = absl::StrCat(line, "\n");
  std::fwrite(text.data(), 1, text.size(), stream);
  std::fflush(stream);
}

}  // namespace

void PrintResult(absl::string_view line) { Print(stdout, line); }
void PrintNote(absl::string_view line) { Print(stderr, line); }

void PrintWarnings(const std::vector<Fault>& warnings) {
  for (const Fault& warning : warnings)
    PrintNote(absl::StrCat("warning: ", warning.field, warning.field.empty() ? "" : ": ",
                           warning.description));
}

void PrintError(const absl::Status& status) { Print(stderr, status.message()); }

}  // namespace cleave
