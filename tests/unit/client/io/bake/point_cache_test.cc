// Bakes as PC2 and MDD.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "tests/unit/client/io/bake/bake_fixture.h"

namespace cleave {
namespace {

using ::cleave::testing::At;
using ::cleave::testing::BakeTest;
using ::cleave::testing::kFrames;
using ::testing::HasSubstr;

float BigEndianFloat(absl::string_view bytes, size_t at) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 4; ++i) bits = bits << 8 | static_cast<uint8_t>(bytes[at + i]);
  float value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

TEST_F(BakeTest, Pc2HasTheObjsVerticesInEveryFrame) {
  options_.velocities = true;
  const BakeResult result = Write(BakeFormat::kPc2);
  EXPECT_EQ(result.path, options_.folder + "/bar.pc2");
  EXPECT_EQ(result.written, kFrames);
  size_t vertices = 0;
  for (const absl::string_view line : absl::StrSplit(Bytes("bar.obj"), '\n')) {
    if (!absl::StartsWith(line, "v ")) continue;
    std::stringstream text{std::string(line.substr(2))};
    for (size_t k = 0; k < 3; ++k) {
      float value = 0;
      text >> value;
      ASSERT_EQ(value, static_cast<float>(surface_.topology.points[vertices].rest[k]));
    }
    ++vertices;
  }
  EXPECT_EQ(vertices, PointCount());
  for (const bool velocities : {false, true}) {
    const std::string bytes = Bytes(velocities ? "bar.velocity.pc2" : "bar.pc2");
    ASSERT_EQ(bytes.size(), 32 + 12 * PointCount() * kFrames);
    EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
    EXPECT_EQ(At<int32_t>(bytes, 12), 1);
    EXPECT_EQ(At<int32_t>(bytes, 16), static_cast<int32_t>(PointCount()));
    EXPECT_EQ(At<float>(bytes, 20), 10.0f);  // the first frame's number
    EXPECT_EQ(At<float>(bytes, 24), 1.0f);
    EXPECT_EQ(At<int32_t>(bytes, 28), kFrames);
    size_t at = 32;
    for (const auto& frame : velocities ? velocities_ : points_) {
      for (const Vec3& vector : frame) {
        for (const double value : vector) {
          ASSERT_EQ(At<float>(bytes, at), static_cast<float>(value));
          at += 4;
        }
      }
    }
  }
  EXPECT_THAT(Bytes("bar.pc2.json"), HasSubstr("\"piece\": 1, \"smallest_node\": 0"));
}

TEST_F(BakeTest, MddIsBigEndianAndTellsWhenFramesAreShown) {
  options_.playback_rate = 24;
  Write(BakeFormat::kMdd);
  const std::string bytes = Bytes("bar.mdd");
  ASSERT_EQ(bytes.size(), 8 + 4 * kFrames + 12 * PointCount() * kFrames);
  EXPECT_EQ(bytes.substr(0, 4), std::string("\0\0\0\6", 4));
  EXPECT_EQ(static_cast<uint8_t>(bytes[7]), PointCount() & 255);
  size_t at = 8;
  for (int64_t i = 0; i < kFrames; ++i, at += 4) {
    EXPECT_NEAR(BigEndianFloat(bytes, at), static_cast<double>(i) / 24, 1e-7);
  }
  for (const auto& frame : points_) {
    for (const Vec3& vector : frame) {
      for (const double value : vector) {
        ASSERT_EQ(BigEndianFloat(bytes, at), static_cast<float>(value));
        at += 4;
      }
    }
  }
}

}  // namespace
}  // namespace cleave
