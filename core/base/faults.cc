#include "core/base/faults.h"

#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

void Keep(std::vector<Fault>& kept, long& count, absl::string_view field,
          absl::string_view description) {
  ++count;
  if (kept.size() < Faults::kMaxKept) {
    kept.push_back({std::string(field), std::string(description)});
  }
}

}  // namespace

void Faults::Error(absl::string_view field, absl::string_view description) {
  Keep(errors_, error_count_, field, description);
}

void Faults::Warning(absl::string_view field, absl::string_view description) {
  Keep(warnings_, warning_count_, field, description);
}

void Faults::Append(absl::string_view prefix, const Faults& other) {
  const long hidden_errors = other.error_count_ - static_cast<long>(other.errors_.size());
  const long hidden_warnings = other.warning_count_ - static_cast<long>(other.warnings_.size());
  for (const Fault& fault : other.errors_)
    Error(absl::StrCat(prefix, fault.field), fault.description);
  for (const Fault& fault : other.warnings_) {
    Warning(absl::StrCat(prefix, fault.field), fault.description);
  }
  error_count_ += hidden_errors;
  warning_count_ += hidden_warnings;
}

absl::Status Faults::ToStatus() const {
  if (ok()) return absl::OkStatus();
  std::string message;
  for (const Fault& fault : errors_) {
    if (!message.empty()) message += '\n';
    absl::StrAppend(&message, fault.field, fault.field.empty() ? "" : ": ", fault.description);
  }
  const long hidden = error_count_ - static_cast<long>(errors_.size());
  if (hidden > 0) absl::StrAppend(&message, "\nand ", hidden, " more");
  return absl::InvalidArgumentError(message);
}

}  // namespace cleave
