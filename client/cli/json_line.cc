#include "client/cli/json_line.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace cleave {

std::string JsonString(absl::string_view text) {
  std::string json = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\')
      absl::StrAppend(&json, "\\", std::string(1, letter));
    else if (letter == '\n')
      json += "\\n";
    else if (static_cast<unsigned char>(letter) < 0x20)
      absl::StrAppendFormat(&json, "\\u%04x", letter);
    else
      json += letter;
  }
  return json + "\"";
}

std::string JsonNumber(double value) {
  return std::isfinite(value) ? absl::StrFormat("%.9g", value) : "null";
}

std::string JsonList(const std::vector<std::string>& values) {
  return absl::StrCat("[", absl::StrJoin(values, ","), "]");
}

JsonLine& JsonLine::Add(absl::string_view name, int64_t value) {
  return AddJson(name, absl::StrCat(value));
}

JsonLine& JsonLine::AddJson(absl::string_view name, absl::string_view json) {
  absl::StrAppend(&members_, members_.size() > 1 ? "," : "", JsonString(name), ":", json);
  return *this;
}

}  // namespace cleave
