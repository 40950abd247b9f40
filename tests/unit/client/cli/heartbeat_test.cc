#include "client/cli/heartbeat.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <vector>

namespace cleave {
namespace {

TEST(Heartbeat, TellsForHowLongUntilTheWorkEnds) {
  std::mutex mutex;
  std::condition_variable told;
  std::vector<double> times;
  {
    const Heartbeat heartbeat(std::chrono::milliseconds(1), [&](double seconds) {
      const std::lock_guard lock(mutex);
      times.push_back(seconds);
      told.notify_one();
    });
    std::unique_lock lock(mutex);
    told.wait(lock, [&] { return times.size() >= 3; });
  }
  const std::vector<double> at_end = times;
  EXPECT_LT(at_end[0], at_end[1]);
  EXPECT_LT(at_end[1], at_end[2]);
}

TEST(Heartbeat, WorkThatIsOverAtOnceIsNotToldOf) {
  bool told = false;
  {
    const Heartbeat heartbeat(std::chrono::hours(1), [&](double) { told = true; });
  }
  EXPECT_FALSE(told);
}

}  // namespace
}  // namespace cleave
