#include "client/io/mesh/scanner.h"

#include <charconv>
#include <system_error>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

bool IsBlank(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\v' || c == '\f';
}

// At most a few dozen printable characters of what the file holds.
std::string Shown(absl::string_view found) {
  constexpr size_t kMostShown = 40;
  if (found.size() > kMostShown)
    return absl::StrCat("`", absl::CEscape(found.substr(0, kMostShown)), "...`");
  return absl::StrCat("`", absl::CEscape(found), "`");
}

template <typename T>
bool Parse(absl::string_view token, T& value) {
  if (!token.empty() && token[0] == '+') token.remove_prefix(1);
  const char* const end = token.data() + token.size();
  const auto [after, error] = std::from_chars(token.data(), end, value);
  return error == std::errc() && after == end;
}

}  // namespace

void Scanner::SkipBlanks() {
  while (offset_ < bytes_.size()) {
    if (comment_ != '\0' && bytes_[offset_] == comment_) {
      while (offset_ < bytes_.size() && bytes_[offset_] != '\n') ++offset_;
    } else if (IsBlank(bytes_[offset_])) {
      ++offset_;
    } else {
      return;
    }
  }
}

bool Scanner::AtEnd() {
  SkipBlanks();
  return offset_ == bytes_.size();
}

absl::string_view Scanner::PeekToken() {
  if (!ok()) return {};
  SkipBlanks();
  size_t end = offset_;
  while (end < bytes_.size() && !IsBlank(bytes_[end]) &&
         (comment_ == '\0' || bytes_[end] != comment_)) {
    ++end;
  }
  return bytes_.substr(offset_, end - offset_);
}

absl::string_view Scanner::Token(absl::string_view what) {
  const absl::string_view token = PeekToken();
  if (token.empty() && ok()) FailExpecting(what, {});
  offset_ += token.size();
  return token;
}

template <typename T>
T Scanner::Value(absl::string_view what) {
  const absl::string_view token = PeekToken();
  T value = 0;
  if (!ok()) return 0;
  if (!Parse(token, value)) {
    FailExpecting(what, token);
    return 0;
  }
  offset_ += token.size();
  return value;
}

double Scanner::Number(absl::string_view what) { return Value<double>(what); }

int64_t Scanner::Integer(absl::string_view what) { return Value<int64_t>(what); }

int64_t Scanner::Count(absl::string_view what) {
  const absl::string_view token = PeekToken();
  const int64_t value = Integer(what);
  if (value >= 0) return value;
  offset_ -= token.size();
  FailExpecting(what, token);
  return 0;
}

void Scanner::Expect(absl::string_view word) {
  const absl::string_view token = PeekToken();
  if (!ok()) return;
  if (token != word) {
    FailExpecting(absl::StrCat("`", word, "`"), token);
    return;
  }
  offset_ += token.size();
}

absl::string_view Scanner::RestOfLine() {
  if (!ok()) return {};
  size_t end = bytes_.find('\n', offset_);
  if (end == absl::string_view::npos) end = bytes_.size();
  const absl::string_view line = bytes_.substr(offset_, end - offset_);
  offset_ = std::min(end + 1, bytes_.size());
  return absl::StripAsciiWhitespace(line);
}

void Scanner::SkipPastLine(absl::string_view line) {
  while (ok()) {
    // Only what follows a line end counts: binary content may hold the word by chance.
    const size_t found = bytes_.find(line, offset_);
    if (found == absl::string_view::npos) {
      FailExpecting(absl::StrCat("`", line, "`"), {});
      return;
    }
    offset_ = found + line.size();
    const bool starts = found == 0 || bytes_[found - 1] == '\n';
    if (starts && RestOfLine().empty()) return;
  }
}

absl::string_view Scanner::Bytes(uint64_t size, absl::string_view what) {
  if (!ok()) return {};
  if (size > left()) {
    FailAtByte(
        absl::StrCat("expected ", what, ", ", size, " bytes, but the file ends after ", left()));
    return {};
  }
  const absl::string_view piece = bytes_.substr(offset_, size);
  offset_ += size;
  return piece;
}

void Scanner::SeekTo(uint64_t offset, absl::string_view what) {
  if (!ok()) return;
  if (offset > bytes_.size()) {
    FailAtByte(
        absl::StrCat(what, " lies at byte ", offset, ", but the file has only ", bytes_.size()));
    return;
  }
  offset_ = offset;
}

void Scanner::Fail(absl::string_view message) {
  if (!ok()) return;
  status_ = absl::InvalidArgumentError(absl::StrCat("line ", Line(), ": ", message));
}

void Scanner::FailAtByte(absl::string_view message) {
  if (!ok()) return;
  status_ = absl::InvalidArgumentError(absl::StrCat("byte ", offset_, ": ", message));
}

int64_t Scanner::Line() const {
  return 1 +
         std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset_), '\n');
}

void Scanner::FailExpecting(absl::string_view what, absl::string_view found) {
  Fail(
      absl::StrCat("expected ", what,
                   found.empty() ? ", but the file ends" : absl::StrCat(", found ", Shown(found))));
}

}  // namespace cleave
