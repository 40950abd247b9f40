#include "client/io/scene/utf8.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(Utf8, IsCheckedByteByByte) {
  EXPECT_EQ(LineOfInvalidUtf8("a\n\xC3\xA4\n\xF0\x9F\x98\x80"), 0);
  EXPECT_EQ(LineOfInvalidUtf8("a\n\xC3"), 2);
  EXPECT_EQ(LineOfInvalidUtf8("\xC0\x80"), 1);          // overlong
  EXPECT_EQ(LineOfInvalidUtf8("\xED\xA0\x80"), 1);      // surrogate
  EXPECT_EQ(LineOfInvalidUtf8("\xF4\x90\x80\x80"), 1);  // beyond U+10FFFF
}

TEST(Utf8, EveryLengthOfSequenceIsAppended) {
  std::string text;
  for (const unsigned code : {0x41u, 0xE4u, 0x20ACu, 0x1F600u}) AppendUtf8(code, text);
  EXPECT_EQ(text, "A\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80");
  EXPECT_EQ(LineOfInvalidUtf8(text), 0);
}

}  // namespace
}  // namespace cleave
