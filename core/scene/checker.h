#ifndef CLEAVE_CORE_SCENE_CHECKER_H_
#define CLEAVE_CORE_SCENE_CHECKER_H_

#include <cmath>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/base/faults.h"
#include "core/base/vec3.h"
#include "core/scene/limits.h"

namespace cleave {

// "list[index].field"
inline std::string At(absl::string_view list, size_t index, absl::string_view field = "") {
  return absl::StrCat(list, "[", index, "]", field.empty() ? "" : ".", field);
}

// Range checks that name field, value and range. All refuse NaN, which fails every comparison.
class Checker {
 public:
  explicit Checker(Faults& faults) : faults_(faults) {}

  // (low, high]
  void Above(absl::string_view field, double value, double low, double high) {
    if (value > low && value <= high) return;
    faults_.Error(field, absl::StrCat(value, " is outside (", low, ", ", high, "]"));
  }
  // [low, high]
  void Within(absl::string_view field, double value, double low, double high) {
    if (value >= low && value <= high) return;
    faults_.Error(field, absl::StrCat(value, " is outside [", low, ", ", high, "]"));
  }
  // (low, high)
  void Between(absl::string_view field, double value, double low, double high) {
    if (value > low && value < high) return;
    faults_.Error(field, absl::StrCat(value, " is outside (", low, ", ", high, ")"));
  }
  void Count(absl::string_view field, int64_t value, int64_t low, int64_t high) {
    if (value >= low && value <= high) return;
    faults_.Error(field, absl::StrCat(value, " is outside [", low, ", ", high, "]"));
  }
  void Coordinates(absl::string_view field, const Vec3& value) {
    for (size_t axis = 0; axis < 3; ++axis) {
      Within(absl::StrCat(field, "[", axis, "]"), value[axis], -limits::kMaxLength,
             limits::kMaxLength);
    }
  }
  void Finite(absl::string_view field, const Vec3& value) {
    for (size_t axis = 0; axis < 3; ++axis) {
      if (std::isfinite(value[axis])) continue;
      faults_.Error(absl::StrCat(field, "[", axis, "]"),
                    absl::StrCat(value[axis], " is not a finite number"));
    }
  }
  void Direction(absl::string_view field, const Vec3& value) {
    Finite(field, value);
    if (value == Vec3{0, 0, 0}) faults_.Error(field, "[0, 0, 0] has no direction");
  }
  void Name(absl::string_view field, absl::string_view name, bool required) {
    if (required && name.empty()) faults_.Error(field, "is empty; a name is required");
    if (static_cast<int64_t>(name.size()) > limits::kMaxNameBytes) {
      faults_.Error(field, absl::StrCat("has ", name.size(), " bytes; at most ",
                                        limits::kMaxNameBytes, " are allowed"));
    }
  }
  void Sha256(absl::string_view field, const std::string& digits) {
    if (digits.size() == 64 && digits.find_first_not_of("0123456789abcdef") == std::string::npos)
      return;
    faults_.Error(field, absl::StrCat("\"", digits.substr(0, limits::kMaxNameBytes),
                                      "\" is not 64 lower-case hex digits"));
  }
  // False when the list is too long to be looked through.
  bool List(absl::string_view field, size_t size, int64_t most = limits::kMaxListItems) {
    if (static_cast<int64_t>(size) <= most) return true;
    faults_.Error(field, absl::StrCat("has ", size, " items; at most ", most, " are allowed"));
    return false;
  }

 private:
  Faults& faults_;
};

// `name` must be one of `names`, those of the node sets.
inline void CheckSetName(absl::string_view field, const std::string& name,
                         const std::set<std::string>& names, Faults& faults) {
  if (names.count(name) > 0) return;
  faults.Error(field, name.empty() ? std::string("is empty; the name of a node set is required")
                                   : absl::StrCat("\"", name.substr(0, limits::kMaxNameBytes),
                                                  "\" is not the name of a node set"));
}

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_CHECKER_H_
