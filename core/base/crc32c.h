#ifndef CLEAVE_CORE_BASE_CRC32C_H_
#define CLEAVE_CORE_BASE_CRC32C_H_

#include <cstdint>

#include "absl/strings/string_view.h"

namespace cleave {

// CRC-32C (Castagnoli, reflected, initial value and final xor of all ones), as in RFC 3720, B.4.
// Pass the previous result as `crc` to go on with a later piece of the same bytes.
uint32_t Crc32c(absl::string_view bytes, uint32_t crc = 0);

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_CRC32C_H_
