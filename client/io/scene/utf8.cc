#include "client/io/scene/utf8.h"

#include <cstddef>

namespace cleave {
namespace {

// Length of the valid UTF-8 sequence that `text` begins with, 0 if it is none (RFC 3629).
size_t Utf8SequenceLength(absl::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const size_t length = lead >= 0xC2 && lead <= 0xDF   ? 2
                        : lead >= 0xE0 && lead <= 0xEF ? 3
                        : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                       : 0;
  if (length == 0 || text.size() < length) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const unsigned second = byte(1);
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F)) return 0;
  if ((lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) return 0;
  return length;
}

}  // namespace

void AppendUtf8(unsigned code, std::string& out) {
  if (code < 0x80) {
    out.push_back(static_cast<char>(code));
    return;
  }
  int continuation = 1;
  if (code < 0x800) {
    out.push_back(static_cast<char>(0xC0 | (code >> 6)));
  } else if (code < 0x10000) {
    out.push_back(static_cast<char>(0xE0 | (code >> 12)));
    continuation = 2;
  } else {
    out.push_back(static_cast<char>(0xF0 | (code >> 18)));
    continuation = 3;
  }
  while (continuation-- > 0)
    out.push_back(static_cast<char>(0x80 | ((code >> (6 * continuation)) & 0x3F)));
}

int LineOfInvalidUtf8(absl::string_view text) {
  int line = 1;
  while (!text.empty()) {
    const size_t length = Utf8SequenceLength(text);
    if (length == 0) return line;
    if (text[0] == '\n') ++line;
    text.remove_prefix(length);
  }
  return 0;
}

}  // namespace cleave
