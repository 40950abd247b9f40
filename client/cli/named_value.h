#ifndef CLEAVE_CLIENT_CLI_NAMED_VALUE_H_
#define CLEAVE_CLIENT_CLI_NAMED_VALUE_H_

#include <CLI/App.hpp>
#include <map>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace cleave {

// Turns the names of an option's values into those of its enum, for CLI::Option::transform; says of
// another name which there are: `foo is none of lattice, unstructured`.
template <typename Enum>
CLI::Validator NamedValue(const std::map<std::string, Enum>& values) {
  const auto transform = [values](std::string& text) -> std::string {
    const auto found = values.find(text);
    if (found == values.end()) {
      return absl::StrCat(text, " is none of ",
                          absl::StrJoin(values, ", ", [](std::string* out, const auto& value) {
                            out->append(value.first);
                          }));
    }
    text = absl::StrCat(static_cast<int>(found->second));
    return "";
  };
  return CLI::Validator(transform, "");
}

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_NAMED_VALUE_H_
