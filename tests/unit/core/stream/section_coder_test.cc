#include "core/stream/section_coder.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "gtest/gtest.h"

namespace cleave {
namespace {

TEST(BytePlanes, HoldEveryResidualInAsFewPlanesAsTheLargestNeeds) {
  constexpr int32_t kMax = std::numeric_limits<int32_t>::max();
  const std::vector<std::pair<std::vector<int32_t>, size_t>> cases = {
      {{0, 0, 0, 0, 0, 0}, 0},
      {{1, -1, 2, -128, 127, 0}, 1},
      {{128, 0, 0, 0, 0, 0}, 2},
      {{-32769, 0, 3, 4, 5, 6}, 3},
      {{kMax, -kMax, 1, 0, -1, 70000}, 4}};
  for (const auto& [residuals, planes] : cases) {
    const std::string bytes = ToBytePlanes(residuals);
    EXPECT_EQ(bytes.size(), planes * residuals.size());
    std::vector<int32_t> back(residuals.size());
    FromBytePlanes(bytes, back);
    EXPECT_EQ(back, residuals);
  }
  EXPECT_EQ(ToBytePlanes(std::vector<int32_t>{1, -1, 2, -2, 3, -3}),
            std::string("\x02\x03\x01\x06\x04\x05", 6));  // x x, y y, z z
}

TEST(Gaps, HoldAscendingIdsAndNothingElse) {
  const std::vector<int32_t> ids = {0, 1, 130, 131, 20000, std::numeric_limits<int32_t>::max()};
  const std::string bytes = ToGaps(ids);
  std::vector<int32_t> back;
  ASSERT_TRUE(FromGaps(bytes, 6, 0, int64_t{1} << 31, back).ok());
  EXPECT_EQ(back, ids);

  const auto refused = [](const std::string& gaps, uint32_t count, int64_t first, int64_t end) {
    std::vector<int32_t> out;
    return absl::IsDataLoss(FromGaps(gaps, count, first, end, out));
  };
  EXPECT_TRUE(refused(bytes, 6, 0, 20001));                         // out of range
  EXPECT_TRUE(refused(bytes, 6, 1, int64_t{1} << 31));              // not above the section before
  EXPECT_TRUE(refused(bytes, 5, 0, int64_t{1} << 31));              // bytes left over
  EXPECT_TRUE(refused(bytes, 7, 0, int64_t{1} << 31));              // too few
  EXPECT_TRUE(refused(std::string("\x80\x00", 2), 1, 0, 100));      // padded
  EXPECT_TRUE(refused("\xff\xff\xff\xff\xff\x01", 1, 0, 1 << 30));  // six bytes
  EXPECT_TRUE(refused("\x80", 1, 0, 100));
}

TEST(Parts, ComeBackStoredOrCompressed) {
  std::string raw(3000, 'a');
  for (size_t at = 2000; at < 3000; ++at) raw[at] = static_cast<char>((at * at * 2654435761u) >> 9);
  const std::string coded = CodeParts(raw, 3);
  EXPECT_LT(coded.size(), 1200u);
  EXPECT_GT(coded.size(), 1000u);  // the last part is noise
  std::string back(raw.size(), '\0');
  ASSERT_TRUE(DecodeParts(coded, 3, back).ok());
  EXPECT_EQ(back, raw);
  for (size_t size = 0; size < coded.size(); ++size) {
    EXPECT_FALSE(DecodeParts(coded.substr(0, size), 3, back).ok()) << size;
  }
  EXPECT_FALSE(DecodeParts(coded + "x", 3, back).ok());
  EXPECT_FALSE(DecodeParts(coded, 2, back).ok());
  EXPECT_TRUE(DecodeParts("", 0, {}).ok());
  EXPECT_FALSE(DecodeParts("x", 0, {}).ok());
}

}  // namespace
}  // namespace cleave
