#ifndef CLEAVE_CORE_BASE_FAULTS_H_
#define CLEAVE_CORE_BASE_FAULTS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cleave {

// One thing that is wrong, or suspicious, about an input.
struct Fault {
  std::string field;        // path as in the scene file: materials[2].poisson_ratio
  std::string description;  // value and allowed range: "0.52 is outside [0, 0.5)"
};

// Collects everything wrong with an input, so that it is reported at once and not fault by fault.
// Not thread-safe.
class Faults {
 public:
  // At most this many faults of each kind are kept; the rest are counted. A mesh with a million
  // bad tets must not answer with a million lines.
  static constexpr int kMaxKept = 100;

  void Error(absl::string_view field, absl::string_view description);
  void Warning(absl::string_view field, absl::string_view description);

  bool ok() const { return error_count_ == 0; }
  const std::vector<Fault>& errors() const { return errors_; }
  const std::vector<Fault>& warnings() const { return warnings_; }
  long error_count() const { return error_count_; }
  long warning_count() const { return warning_count_; }

  // Takes over the faults of `other`, each with `prefix` before its field.
  void Append(absl::string_view prefix, const Faults& other);

  // OK, or InvalidArgument whose message lists every kept fault, one a line.
  absl::Status ToStatus() const;

 private:
  std::vector<Fault> errors_;
  std::vector<Fault> warnings_;
  long error_count_ = 0;
  long warning_count_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_FAULTS_H_
