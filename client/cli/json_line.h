#ifndef CLEAVE_CLIENT_CLI_JSON_LINE_H_
#define CLEAVE_CLIENT_CLI_JSON_LINE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace cleave {

// A JSON string with its quotes.
std::string JsonString(absl::string_view text);
// A JSON number; null for what JSON has no number for.
std::string JsonNumber(double value);
// A JSON list of values that are JSON already.
std::string JsonList(const std::vector<std::string>& values);

// An object on one line, its members in the order in which they are added.
class JsonLine {
 public:
  JsonLine& Add(absl::string_view name, absl::string_view text) {
    return AddJson(name, JsonString(text));
  }
  JsonLine& Add(absl::string_view name, const char* text) {
    return AddJson(name, JsonString(text));
  }
  JsonLine& Add(absl::string_view name, double value) { return AddJson(name, JsonNumber(value)); }
  JsonLine& Add(absl::string_view name, int64_t value);
  JsonLine& Add(absl::string_view name, bool value) {
    return AddJson(name, value ? "true" : "false");
  }
  // `json` is a value already.
  JsonLine& AddJson(absl::string_view name, absl::string_view json);

  std::string Str() const { return members_ + "}"; }

 private:
  std::string members_ = "{";
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_JSON_LINE_H_
