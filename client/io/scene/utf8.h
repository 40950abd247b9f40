#ifndef CLEAVE_CLIENT_IO_SCENE_UTF8_H_
#define CLEAVE_CLIENT_IO_SCENE_UTF8_H_

#include <string>

#include "absl/strings/string_view.h"

namespace cleave {

// Appends a code point, at most 0x10FFFF and no surrogate.
void AppendUtf8(unsigned code, std::string& out);

// The line, from 1, of the first byte that is not part of valid UTF-8; 0 when all is.
int LineOfInvalidUtf8(absl::string_view text);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SCENE_UTF8_H_
