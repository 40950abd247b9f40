// Bakes as USD text.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "tests/unit/client/io/bake/bake_fixture.h"

namespace cleave {
namespace {

using ::cleave::testing::BakeTest;
using ::cleave::testing::kFrames;
using ::testing::HasSubstr;

TEST_F(BakeTest, UsdaHasASampleAFrameOfPointsAndVelocities) {
  options_.playback_rate = 5;  // half as fast as simulated
  Write(BakeFormat::kUsda);
  const std::string text = Bytes("bar.usda");
  EXPECT_TRUE(absl::StartsWith(text, "#usda 1.0\n"));
  EXPECT_THAT(text, HasSubstr("upAxis = \"Z\""));
  EXPECT_THAT(text, HasSubstr("timeCodesPerSecond = 5\n"));
  EXPECT_THAT(text, HasSubstr("startTimeCode = 10\n    endTimeCode = 15\n"));
  EXPECT_THAT(text, HasSubstr("rel material:binding = </bar/inside_3>"));
  for (const auto& [open, close] : {std::pair{'(', ')'}, {'[', ']'}, {'{', '}'}}) {
    EXPECT_EQ(std::count(text.begin(), text.end(), open),
              std::count(text.begin(), text.end(), close));
  }
  for (const bool velocities : {false, true}) {
    const size_t begin = text.find(velocities ? "vector3f[] velocities.timeSamples = {"
                                              : "point3f[] points.timeSamples = {");
    ASSERT_NE(begin, std::string::npos);
    const std::vector<std::string> lines =
        absl::StrSplit(text.substr(begin, text.find('}', begin) - begin), '\n');
    ASSERT_EQ(lines.size(), kFrames + 2);  // its head, and what is before the brace
    for (size_t i = 0; i < kFrames; ++i) {
      std::string line = lines[i + 1];
      EXPECT_THAT(line, HasSubstr(absl::StrCat(" ", 10 + i, ": [")));
      line = line.substr(line.find('['));
      for (char& letter : line) {
        if (absl::StrContains("[](),", absl::string_view(&letter, 1))) letter = ' ';
      }
      std::stringstream numbers(line);
      for (const Vec3& vector : velocities ? velocities_[i] : points_[i]) {
        for (const double value : vector) {
          double read = 0;
          ASSERT_TRUE(numbers >> read);
          ASSERT_NEAR(read, velocities ? 0.5 * value : value, 1e-6);
        }
      }
      double more = 0;
      EXPECT_FALSE(numbers >> more);
    }
  }
}

}  // namespace
}  // namespace cleave
