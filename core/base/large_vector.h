#ifndef CLEAVE_CORE_BASE_LARGE_VECTOR_H_
#define CLEAVE_CORE_BASE_LARGE_VECTOR_H_

#include <cstddef>
#include <new>
#include <vector>

namespace cleave {

// Memory that asks for pages of 2 MiB once it is as large as one. What is read here and there in a
// hundred megabytes is then found without walks through page tables. Throws std::bad_alloc.
void* AllocateLarge(size_t bytes, size_t alignment);
void FreeLarge(void* memory);

template <typename T>
struct LargePages {
  using value_type = T;

  LargePages() = default;
  template <typename Other>
  LargePages(const LargePages<Other>&) {}  // an allocator converts

  T* allocate(size_t count) {
    if (count > static_cast<size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(AllocateLarge(count * sizeof(T), alignof(T)));
  }
  void deallocate(T* memory, size_t) { FreeLarge(memory); }

  bool operator==(const LargePages&) const { return true; }
};

// For arrays by node, edge or tet that are read in no order.
template <typename T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_LARGE_VECTOR_H_
