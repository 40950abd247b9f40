#ifndef CLEAVE_CLIENT_IO_EXPORT_NUMBER_TEXT_H_
#define CLEAVE_CLIENT_IO_EXPORT_NUMBER_TEXT_H_

#include <array>
#include <charconv>
#include <string>

#include "core/base/vec3.h"

namespace cleave {

// Appends the shortest text that reads back as the same number. A number is finite and at most 24
// characters long.
template <typename T>
void AppendNumber(T value, std::string& out) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  out.append(text.data(), end.ptr);
}

// The coordinates as floats, with `between` between them.
inline void AppendFloats(const Vec3& vector, const char* between, std::string& out) {
  AppendNumber(static_cast<float>(vector[0]), out);
  out += between;
  AppendNumber(static_cast<float>(vector[1]), out);
  out += between;
  AppendNumber(static_cast<float>(vector[2]), out);
}

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_NUMBER_TEXT_H_
