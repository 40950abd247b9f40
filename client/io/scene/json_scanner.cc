#include "client/io/scene/json_scanner.h"

#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/io/scene/utf8.h"

namespace cleave {
JsonScanner::JsonScanner(absl::string_view text) : left_(text) {
  if (absl::StartsWith(left_, "\xEF\xBB\xBF")) left_.remove_prefix(3);  // byte order mark
}

bool JsonScanner::Fail(std::string message) {
  if (error_.empty()) error_ = std::move(message);
  left_ = {};
  return false;
}

void JsonScanner::SkipSpace() {
  while (!left_.empty() &&
         (left_[0] == ' ' || left_[0] == '\t' || left_[0] == '\r' || left_[0] == '\n')) {
    if (left_[0] == '\n') ++line_;
    left_.remove_prefix(1);
  }
}

JsonScanner::Kind JsonScanner::Peek() {
  if (failed()) return Kind::kError;
  SkipSpace();
  if (left_.empty()) {
    Fail("the file ends where a value should be");
    return Kind::kError;
  }
  const char next = left_[0];
  if (next == '{') return Kind::kObject;
  if (next == '[') return Kind::kArray;
  if (next == '"') return Kind::kString;
  if (next == '-' || absl::ascii_isdigit(static_cast<unsigned char>(next))) return Kind::kNumber;
  if (absl::StartsWith(left_, "true") || absl::StartsWith(left_, "false")) return Kind::kBool;
  if (absl::StartsWith(left_, "null")) return Kind::kNull;
  if (next == '/' || next == '#')
    Fail("JSON has no comments; a .textproto scene may have them (with #)");
  else if (next == '\'')
    Fail("strings stand in double quotes");
  else if (next == '}' || next == ']' || next == ',')
    Fail(absl::StrCat("a value is missing before '", left_.substr(0, 1), "'"));
  else
    Fail("this is not a JSON value");
  return Kind::kError;
}

bool JsonScanner::Begin(char bracket) {
  SkipSpace();
  if (failed() || left_.empty() || left_[0] != bracket)
    return Fail(absl::StrCat("'", std::string(1, bracket), "' is missing"));
  if (++depth_ > kMaxDepth) return Fail(absl::StrCat("nested deeper than ", kMaxDepth, " levels"));
  left_.remove_prefix(1);
  return true;
}

bool JsonScanner::Next(Cursor& cursor, char close) {
  if (failed()) return false;
  SkipSpace();
  if (left_.empty())
    return Fail(absl::StrCat("the file ends before '", std::string(1, close), "'"));
  if (left_[0] == close) {
    left_.remove_prefix(1);
    --depth_;
    return false;
  }
  if (cursor.started) {
    if (left_[0] == '/' || left_[0] == '#')
      return Fail("JSON has no comments; a .textproto scene may have them (with #)");
    if (left_[0] != ',')
      return Fail(absl::StrCat("',' or '", std::string(1, close), "' is missing"));
    left_.remove_prefix(1);
    SkipSpace();
    if (!left_.empty() && left_[0] == close)
      return Fail(absl::StrCat("',' before '", std::string(1, close), "' must go"));
  }
  cursor.started = true;
  return true;
}

bool JsonScanner::NextMember(Cursor& cursor, std::string& key) {
  if (!Next(cursor, '}')) return false;
  if (left_.empty() || left_[0] != '"') {
    if (!left_.empty() && (left_[0] == '/' || left_[0] == '#'))
      return Fail("JSON has no comments; a .textproto scene may have them (with #)");
    return Fail("a field name in double quotes is missing");
  }
  if (!ReadString(key)) return false;
  SkipSpace();
  if (left_.empty() || left_[0] != ':')
    return Fail(absl::StrCat("':' is missing after \"", key, "\""));
  left_.remove_prefix(1);
  return true;
}

bool JsonScanner::NextItem(Cursor& cursor) { return Next(cursor, ']'); }

bool JsonScanner::ReadCodeUnit(unsigned& unit) {
  if (left_.size() < 4) return Fail("a \\u escape needs four hexadecimal digits");
  unit = 0;
  for (int i = 0; i < 4; ++i) {
    const char digit = absl::ascii_tolower(static_cast<unsigned char>(left_[i]));
    if (!absl::ascii_isxdigit(static_cast<unsigned char>(digit)))
      return Fail("a \\u escape needs four hexadecimal digits");
    unit = unit * 16 + static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'a' + 10);
  }
  left_.remove_prefix(4);
  return true;
}

bool JsonScanner::ReadEscape(std::string& value) {
  if (left_.empty()) return Fail("the file ends inside a string");
  const char kind = left_[0];
  left_.remove_prefix(1);
  switch (kind) {
    case '"':
    case '\\':
    case '/':
      value.push_back(kind);
      return true;
    case 'b':
      value.push_back('\b');
      return true;
    case 'f':
      value.push_back('\f');
      return true;
    case 'n':
      value.push_back('\n');
      return true;
    case 'r':
      value.push_back('\r');
      return true;
    case 't':
      value.push_back('\t');
      return true;
    case 'u':
      break;
    default:
      return Fail("this backslash escape is not one of JSON's");
  }
  unsigned unit = 0;
  if (!ReadCodeUnit(unit)) return false;
  if (unit >= 0xD800 && unit <= 0xDBFF) {
    unsigned low = 0;
    if (!absl::ConsumePrefix(&left_, "\\u")) return Fail("half of a \\u surrogate pair is missing");
    if (!ReadCodeUnit(low)) return false;
    if (low < 0xDC00 || low > 0xDFFF) return Fail("half of a \\u surrogate pair is missing");
    unit = 0x10000 + ((unit - 0xD800) << 10) + (low - 0xDC00);
  } else if (unit >= 0xDC00 && unit <= 0xDFFF) {
    return Fail("half of a \\u surrogate pair is missing");
  }
  AppendUtf8(unit, value);
  return true;
}

bool JsonScanner::ReadString(std::string& value) {
  value.clear();
  SkipSpace();
  if (failed() || !absl::ConsumePrefix(&left_, "\"")) return Fail("a string is missing");
  while (!left_.empty()) {
    const char next = left_[0];
    left_.remove_prefix(1);
    if (next == '"') return true;
    if (next == '\\') {
      if (!ReadEscape(value)) return false;
    } else if (static_cast<unsigned char>(next) < 0x20) {
      return Fail("a string may not hold line breaks or control characters");
    } else {
      value.push_back(next);
    }
  }
  return Fail("the file ends inside a string");
}

bool JsonScanner::ReadNumber(absl::string_view& digits) {
  SkipSpace();
  const absl::string_view begin = left_;
  const auto digit_run = [&] {
    size_t count = 0;
    while (!left_.empty() && absl::ascii_isdigit(static_cast<unsigned char>(left_[0]))) {
      left_.remove_prefix(1);
      ++count;
    }
    return count;
  };
  absl::ConsumePrefix(&left_, "-");
  const bool leading_zero = absl::StartsWith(left_, "0");
  const size_t whole = digit_run();
  bool good = whole == 1 || (whole > 1 && !leading_zero);
  if (absl::ConsumePrefix(&left_, ".")) good = digit_run() > 0 && good;
  if (absl::ConsumePrefix(&left_, "e") || absl::ConsumePrefix(&left_, "E")) {
    if (!absl::ConsumePrefix(&left_, "+")) absl::ConsumePrefix(&left_, "-");
    good = digit_run() > 0 && good;
  }
  digits = begin.substr(0, begin.size() - left_.size());
  // A letter that follows belongs to the mistake: 1.5m, 0x10.
  if (!left_.empty() && absl::ascii_isalnum(static_cast<unsigned char>(left_[0]))) good = false;
  if (!good) {
    size_t end = digits.size();
    while (end < begin.size() && end < 40 &&
           (absl::ascii_isalnum(static_cast<unsigned char>(begin[end])) || begin[end] == '.'))
      ++end;
    return Fail(absl::StrCat("'", begin.substr(0, end), "' is not a JSON number"));
  }
  return true;
}

bool JsonScanner::ReadBool(bool& value) {
  SkipSpace();
  value = absl::StartsWith(left_, "true");
  if (absl::ConsumePrefix(&left_, "true") || absl::ConsumePrefix(&left_, "false")) return true;
  return Fail("true or false is missing");
}

bool JsonScanner::ReadNull() {
  SkipSpace();
  return absl::ConsumePrefix(&left_, "null") || Fail("null is missing");
}

bool JsonScanner::SkipValue() {
  std::string text;
  absl::string_view digits;
  bool flag = false;
  Cursor cursor;
  switch (Peek()) {
    case Kind::kObject:
      if (!BeginObject()) return false;
      while (NextMember(cursor, text))
        if (!SkipValue()) return false;
      return !failed();
    case Kind::kArray:
      if (!BeginArray()) return false;
      while (NextItem(cursor))
        if (!SkipValue()) return false;
      return !failed();
    case Kind::kString:
      return ReadString(text);
    case Kind::kNumber:
      return ReadNumber(digits);
    case Kind::kBool:
      return ReadBool(flag);
    case Kind::kNull:
      return ReadNull();
    case Kind::kError:
      break;
  }
  return false;
}

bool JsonScanner::ReadEnd() {
  SkipSpace();
  if (!failed() && !left_.empty()) return Fail("something follows the end of the scene");
  return !failed();
}

}  // namespace cleave
