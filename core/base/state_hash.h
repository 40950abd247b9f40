#ifndef CLEAVE_CORE_BASE_STATE_HASH_H_
#define CLEAVE_CORE_BASE_STATE_HASH_H_

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstddef>
#include <cstdint>

#include "absl/strings/string_view.h"

namespace cleave {

// A 64-bit digest (XXH3) that names a state for equality checks. Not for security: assets are named
// by SHA-256.
class StateHash {
 public:
  StateHash() { XXH3_64bits_reset(&state_); }
  void Update(const void* data, size_t size) { XXH3_64bits_update(&state_, data, size); }
  uint64_t Digest() const { return XXH3_64bits_digest(&state_); }

  static uint64_t Of(absl::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

 private:
  XXH3_state_t state_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_STATE_HASH_H_
