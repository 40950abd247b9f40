#include "client/cli/bounded_stop.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>

namespace cleave {
namespace {

void WorkWithoutEnd() {
  Interrupt interrupt;
  const BoundedStop bounded(interrupt, std::chrono::milliseconds(1));
  kill(getpid(), SIGINT);
  while (true) pause();
}

TEST(BoundedStop, EndsWorkThatDoesNotStopByItself) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(WorkWithoutEnd(), ::testing::ExitedWithCode(130), "stopped within a frame");
}

TEST(BoundedStop, RequestsAStopAndLetsWorkEndThatHeedsIt) {
  Interrupt interrupt;
  {
    const BoundedStop bounded(interrupt, std::chrono::minutes(10));
    kill(getpid(), SIGINT);
    while (!interrupt.stop().requested()) sched_yield();
  }
  EXPECT_EQ(interrupt.signal(), SIGINT);
}

}  // namespace
}  // namespace cleave
