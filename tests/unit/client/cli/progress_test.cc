#include "client/cli/progress.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(Progress, SecondsReadWellAtEveryScale) {
  EXPECT_EQ(FormatSeconds(0.04), "40 ms");
  EXPECT_EQ(FormatSeconds(0.00123), "1.2 ms");
  EXPECT_EQ(FormatSeconds(0.0996), "0.1 s");
  EXPECT_EQ(FormatSeconds(9.94), "9.9 s");
  EXPECT_EQ(FormatSeconds(42.4), "42 s");
  EXPECT_EQ(FormatSeconds(59.7), "1 min 00 s");
  EXPECT_EQ(FormatSeconds(185), "3 min 05 s");
  EXPECT_EQ(FormatSeconds(7805), "2 h 10 min");
  EXPECT_EQ(FormatSeconds(-1), "?");
}

TEST(Progress, BytesReadWellAtEveryScale) {
  EXPECT_EQ(FormatBytes(912), "912 B");
  EXPECT_EQ(FormatBytes(1024), "1.0 KiB");
  EXPECT_EQ(FormatBytes(1.3 * 1024 * 1024), "1.3 MiB");
  EXPECT_EQ(FormatBytes(640.0 * 1024 * 1024 * 1024), "640 GiB");
}

TEST(Progress, LineForALogHasAllNumbers) {
  EXPECT_EQ(ProgressText({12, 48, 0.5, 34, 1, 70.0}),
            "frame 12 of 48, time 0.5 s, 34 broken edges, 1 piece, 1 min 10 s left");
  EXPECT_EQ(ProgressText({48, 48, 2, 1, 3, 0.0}),
            "frame 48 of 48, time 2 s, 1 broken edge, 3 pieces");
}

TEST(Progress, BarFillsWithTheShareAndFitsTheWidth) {
  EXPECT_EQ(ProgressBar({12, 48, 0.5, 34, 3, 70.0}, 100),
            "[#######-----------------------] 12/48  0.5 s  ETA 1 min 10 s  34 edges broken  "
            "3 pieces");
  EXPECT_EQ(ProgressBar({0, 0, 0, 0, 1, std::nullopt}, 100).substr(0, 32),
            "[##############################]");
  EXPECT_EQ(ProgressBar({12, 48, 0.5, 34, 3, 70.0}, 60),
            "12/48  0.5 s  ETA 1 min 10 s  34 edges broken  3 pieces");
  for (int width = 0; width < 120; ++width)
    EXPECT_LE(ProgressBar({12, 48, 0.5, 34, 3, 70.0}, width).size(), static_cast<size_t>(width));
}

TEST(Progress, TimeLeftCountsOnlyFramesThatWereComputed) {
  TimeLeft time_left;
  time_left.StartAt(10, 100);
  EXPECT_FALSE(time_left.Estimate(10, 48, 101).has_value());
  EXPECT_DOUBLE_EQ(*time_left.Estimate(14, 48, 108), 2.0 * 34);
  EXPECT_DOUBLE_EQ(*time_left.Estimate(50, 48, 108), 0);
}

}  // namespace
}  // namespace cleave
