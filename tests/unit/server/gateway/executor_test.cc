#include "server/gateway/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>

namespace cleave {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

TEST(ExecutorTest, TasksRunOnOtherThreads) {
  Executor executor(2);
  std::promise<std::thread::id> thread;
  executor.Submit([&] { thread.set_value(std::this_thread::get_id()); });
  EXPECT_NE(thread.get_future().get(), std::this_thread::get_id());
}

TEST(ExecutorTest, TimersFireInTheOrderOfTheirTimes) {
  Executor executor(1);
  std::promise<void> done;
  std::vector<int> order;
  const auto now = Executor::Clock::now();
  executor.SubmitAt(now + milliseconds(30), [&] {
    order.push_back(2);
    done.set_value();
  });
  executor.SubmitAt(now + milliseconds(10), [&] { order.push_back(1); });
  done.get_future().wait();
  EXPECT_EQ(order, (std::vector<int>{1, 2}));
}

TEST(ExecutorTest, ACancelledTimerLetsGoOfWhatItHolds) {
  Executor executor(1);
  const auto held = std::make_shared<int>(1);
  const Executor::TimerId timer =
      executor.SubmitAt(Executor::Clock::now() + hours(1), [held] { FAIL(); });
  EXPECT_EQ(held.use_count(), 2);
  executor.Cancel(timer);
  EXPECT_EQ(held.use_count(), 1);
  executor.Cancel(timer);
}

TEST(ExecutorTest, AnExecutorEndsWithTimersAndTasksLeft) {
  Executor executor(1);
  executor.SubmitAt(Executor::Clock::now() + hours(1), [] {});
}

TEST(PumpTest, ATaskNeverRunsTwiceAtOnceAndAWakeIsNeverLost) {
  auto executor = std::make_unique<Executor>(4);
  const auto owner = std::make_shared<int>(0);
  std::atomic<int> inside = 0;
  std::atomic<int> wanted = 0;
  std::atomic<int> seen = 0;
  std::promise<void> caught_up;
  std::atomic<bool> overlapped = false;
  Pump pump(*executor, [&] {
    if (++inside > 1) overlapped = true;
    seen = wanted.load();
    --inside;
    if (seen == 1000 && owner.use_count() > 0) {
      static std::once_flag once;
      std::call_once(once, [&] { caught_up.set_value(); });
    }
  });
  for (int i = 0; i < 1000; ++i) {
    ++wanted;
    pump.Wake(owner);
  }
  caught_up.get_future().wait();
  executor.reset();  // the last run may still be in the pump, which nothing else keeps
  EXPECT_FALSE(overlapped);
}

}  // namespace
}  // namespace cleave
