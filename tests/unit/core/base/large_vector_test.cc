#include "core/base/large_vector.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <new>

namespace cleave {
namespace {

struct alignas(64) Line {
  int64_t number = 0;
};

bool StartsAt(const void* memory, size_t alignment) {
  return reinterpret_cast<uintptr_t>(memory) % alignment == 0;
}

TEST(LargeVectorTest, KeepsWhatItHoldsWhileItGrowsAboveAPage) {
  LargeVector<Line> lines;
  for (int64_t number = 0; number < 100'000; ++number) {
    lines.push_back({number});
    ASSERT_TRUE(StartsAt(lines.data(), alignof(Line)));
  }
  EXPECT_TRUE(StartsAt(lines.data(), size_t{1} << 21));
  for (int64_t number = 0; number < 100'000; ++number) {
    ASSERT_EQ(lines[static_cast<size_t>(number)].number, number);
  }
}

TEST(LargeVectorTest, RefusesMoreThanThereIs) {
  LargePages<Line> pages;
  EXPECT_THROW(pages.allocate(static_cast<size_t>(-1) / 2), std::bad_array_new_length);
  EXPECT_THROW(pages.allocate(size_t{1} << 56), std::bad_alloc);
}

}  // namespace
}  // namespace cleave
