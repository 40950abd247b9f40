#include "core/base/frame_line.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(FrameLineTest, AWholeLineNamesItsFrame) {
  EXPECT_EQ(FrameOfLine(R"({"frame":12,"time":0.5})"), 12);
  EXPECT_EQ(FrameOfLine(R"({"frame":0})"), 0);
}

TEST(FrameLineTest, ATornOrForeignLineHasNone) {
  for (const char* line :
       {"", "{", R"({"frame":)", R"({"frame":1)", R"({"frame":12,"time":0.)",
        R"({"frame":x,"time":0.5})", R"({"frame":-7})", R"({"time":0.5,"frame":12})"})
    EXPECT_EQ(FrameOfLine(line), -1) << line;
}

}  // namespace
}  // namespace cleave
