#ifndef CLEAVE_CLIENT_IO_MESH_SCANNER_H_
#define CLEAVE_CLIENT_IO_MESH_SCANNER_H_

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace cleave {

// Reads text and binary values from a file in memory that nobody vouches for. The first failure
// sticks: it keeps its message, and every later read gives zero or nothing, so that a loop needs
// one look at ok() a turn. `what` names what is expected, for the message. Bytes are not copied and
// must outlive the scanner.
class Scanner {
 public:
  explicit Scanner(absl::string_view bytes) : bytes_(bytes) {}

  bool ok() const { return status_.ok(); }
  const absl::Status& status() const { return status_; }
  size_t offset() const { return offset_; }
  size_t left() const { return bytes_.size() - offset_; }

  // Lines that start with this character, after blanks, and the rest of lines from it on are
  // passed over by the text reads below. None unless set.
  void SetComment(char comment) { comment_ = comment; }

  // ---- text; white space and line ends before a token are passed over
  // Nothing left but white space and comments.
  bool AtEnd();
  // The next token without taking it; empty at the end.
  absl::string_view PeekToken();
  absl::string_view Token(absl::string_view what);
  double Number(absl::string_view what);
  int64_t Integer(absl::string_view what);
  // As Integer, and fails when the value is negative.
  int64_t Count(absl::string_view what);
  // Takes a token that must be `word`.
  void Expect(absl::string_view word);
  // What is left of the line, without its end and without blanks around it. Comments are kept.
  absl::string_view RestOfLine();
  // Everything up to and including the next line that is `line`, blanks apart.
  void SkipPastLine(absl::string_view line);

  // ---- binary
  void SetSwapped(bool swapped) { swapped_ = swapped; }
  template <typename T>
  T Binary(absl::string_view what) {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    const absl::string_view raw = Bytes(sizeof(T), what);
    if (raw.size() != sizeof(T)) return value;
    char buffer[sizeof(T)];
    std::memcpy(buffer, raw.data(), sizeof(T));
    if (swapped_) std::reverse(buffer, buffer + sizeof(T));
    std::memcpy(&value, buffer, sizeof(T));
    return value;
  }
  absl::string_view Bytes(uint64_t size, absl::string_view what);
  void SeekTo(uint64_t offset, absl::string_view what);

  // Records a failure at the current place, unless there was one before: "line 12: message".
  void Fail(absl::string_view message);
  // Records a failure at the current byte: "byte 120: message".
  void FailAtByte(absl::string_view message);
  // The line, from 1, that the current place is on.
  int64_t Line() const;

 private:
  void SkipBlanks();
  template <typename T>
  T Value(absl::string_view what);
  void FailExpecting(absl::string_view what, absl::string_view found);

  absl::string_view bytes_;
  size_t offset_ = 0;
  char comment_ = '\0';
  bool swapped_ = false;
  absl::Status status_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_SCANNER_H_
