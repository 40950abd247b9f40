#include "core/base/bytes.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(ByteReader, ReadsBackWhatByteWriterWrote) {
  std::string bytes;
  ByteWriter writer(bytes);
  writer.Put<uint16_t>(7);
  writer.Put(2.5);
  writer.PutVector(std::vector<int32_t>{1, -2, 3});
  ByteReader reader(bytes);
  EXPECT_EQ(reader.Get<uint16_t>(), 7);
  EXPECT_EQ(reader.Get<double>(), 2.5);
  EXPECT_EQ(reader.GetVector<int32_t>(), (std::vector<int32_t>{1, -2, 3}));
  EXPECT_TRUE(reader.Finish("record").ok());
}

TEST(ByteReader, RefusesEveryTruncation) {
  std::string bytes;
  ByteWriter writer(bytes);
  writer.PutVector(std::vector<double>{1, 2, 3});
  for (size_t size = 0; size < bytes.size(); ++size) {
    ByteReader reader(absl::string_view(bytes).substr(0, size));
    EXPECT_TRUE(reader.GetVector<double>().empty());
    EXPECT_FALSE(reader.Finish("record").ok());
  }
}

TEST(ByteReader, AllocatesNothingForACountThatLies) {
  std::string bytes;
  ByteWriter(bytes).Put<uint64_t>(uint64_t{1} << 62);
  ByteReader reader(bytes);
  EXPECT_TRUE(reader.GetVector<double>().empty());
  EXPECT_FALSE(reader.ok());
}

TEST(ByteReader, RefusesBytesLeftOver) {
  ByteReader reader("xx");
  reader.Get<char>();
  EXPECT_FALSE(reader.Finish("record").ok());
}

}  // namespace
}  // namespace cleave
