#include "client/cli/interrupt.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>

namespace cleave {
namespace {

void WorkWithoutEnd(std::chrono::milliseconds patience, int signals) {
  Interrupt interrupt(patience);
  for (int i = 0; i < signals; ++i) {
    kill(getpid(), SIGINT);
    while (!interrupt.stop().requested()) sched_yield();
  }
  while (true) pause();
}

TEST(InterruptDeathTest, CutsOffWorkThatDoesNotStopByItself) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(WorkWithoutEnd(std::chrono::milliseconds(1), 1), ::testing::ExitedWithCode(130),
              "stopped in the middle of its work");
}

TEST(InterruptDeathTest, SecondSignalCutsOffAtOnce) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(WorkWithoutEnd(std::chrono::hours(1), 2), ::testing::ExitedWithCode(130),
              "stopped in the middle of its work");
}

TEST(Interrupt, RequestsAStopAndLetsWorkEndThatHeedsIt) {
  Interrupt interrupt(std::chrono::hours(1));
  kill(getpid(), SIGINT);
  while (!interrupt.stop().requested()) sched_yield();
  EXPECT_EQ(interrupt.signal(), SIGINT);
}

TEST(Interrupt, HandlerDecidesAlone) {
  Interrupt interrupt(std::chrono::milliseconds(0));
  std::atomic<int> count{0};
  const ScopedHandler handler(interrupt, [&](int, int so_many) { count = so_many; });
  for (int i = 1; i <= 2; ++i) {
    kill(getpid(), SIGTERM);
    while (count != i) sched_yield();
  }
  EXPECT_FALSE(interrupt.stop().requested());
}

}  // namespace
}  // namespace cleave
