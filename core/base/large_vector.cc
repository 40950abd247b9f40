#include "core/base/large_vector.h"

#include <algorithm>
#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace cleave {

void* AllocateLarge(size_t bytes, size_t alignment) {
  constexpr size_t kPageBytes = size_t{1} << 21;
  const bool is_large = bytes >= kPageBytes;
  void* memory = nullptr;
  if (posix_memalign(&memory, is_large ? kPageBytes : std::max(alignment, sizeof(void*)), bytes) !=
      0) {
    throw std::bad_alloc();
  }
#ifdef __linux__
  // A wish: where it is not granted all is the same, but slower.
  if (is_large) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
  return memory;
}

void FreeLarge(void* memory) { std::free(memory); }

}  // namespace cleave
