#ifndef CLEAVE_CLIENT_IO_SCENE_JSON_SCANNER_H_
#define CLEAVE_CLIENT_IO_SCENE_JSON_SCANNER_H_

#include <string>

#include "absl/strings/string_view.h"

namespace cleave {

// Walks strict JSON (RFC 8259) front to back and knows the line of everything, which protobuf's own
// parser does not. Holds no tree, so memory does not grow with the input. The first error ends the
// walk: every later call answers false. Not thread-safe.
class JsonScanner {
 public:
  static constexpr int kMaxDepth = 100;

  enum class Kind { kObject, kArray, kString, kNumber, kBool, kNull, kError };

  // Progress inside one object or array.
  struct Cursor {
    bool started = false;
  };

  // `text` must outlive the scanner.
  explicit JsonScanner(absl::string_view text);

  // What the next value is; consumes only white space before it.
  Kind Peek();
  // Line, from 1, of what Peek or NextMember last looked at.
  int line() const { return line_; }

  // Consumes "{" or "[".
  bool BeginObject() { return Begin('{'); }
  bool BeginArray() { return Begin('['); }
  // Moves to the next member or item; false at the end (which it consumes) and on an error.
  bool NextMember(Cursor& cursor, std::string& key);
  bool NextItem(Cursor& cursor);

  bool ReadString(std::string& value);
  // The number as it is written.
  bool ReadNumber(absl::string_view& digits);
  bool ReadBool(bool& value);
  bool ReadNull();
  bool SkipValue();
  // Nothing but white space may follow.
  bool ReadEnd();

  bool failed() const { return !error_.empty(); }
  const std::string& error() const { return error_; }

 private:
  bool Fail(std::string message);
  void SkipSpace();
  bool Begin(char bracket);
  bool Next(Cursor& cursor, char close);
  bool ReadEscape(std::string& value);
  bool ReadCodeUnit(unsigned& unit);

  absl::string_view left_;
  int line_ = 1;
  int depth_ = 0;
  std::string error_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SCENE_JSON_SCANNER_H_
