#include "client/cli/number_check.h"

#include <string>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

CLI::Validator Check(double low, double high, bool with_low) {
  const std::string range = absl::StrCat(with_low ? "[" : "(", low, ", ", high, "]");
  const auto check = [=](std::string& text) -> std::string {
    double value = 0;
    if (!absl::SimpleAtod(text, &value)) return absl::StrCat("\"", text, "\" is not a number");
    const bool is_within = (with_low ? value >= low : value > low) && value <= high;
    return is_within ? "" : absl::StrCat(text, " is outside ", range);
  };
  return CLI::Validator(check, absl::StrCat("in ", range));
}

}  // namespace

CLI::Validator NumberWithin(double low, double high) { return Check(low, high, true); }

CLI::Validator NumberAbove(double low, double high) { return Check(low, high, false); }

CLI::Validator CountWithin(int64_t low, int64_t high) {
  const std::string range = absl::StrCat("[", low, ", ", high, "]");
  const auto check = [=](std::string& text) -> std::string {
    int64_t value = 0;
    if (!absl::SimpleAtoi(text, &value))
      return absl::StrCat("\"", text, "\" is not a whole number in ", range);
    return value >= low && value <= high ? "" : absl::StrCat(text, " is outside ", range);
  };
  return CLI::Validator(check, absl::StrCat("in ", range));
}

}  // namespace cleave
