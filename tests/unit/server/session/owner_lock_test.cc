#include "server/session/owner_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <optional>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

TEST(OwnerLockTest, ASecondOwnerIsRefusedWithThePidOfTheFirst) {
  TemporaryDirectory directory;
  absl::StatusOr<OwnerLock> first = OwnerLock::Acquire(directory / "owner");
  ASSERT_TRUE(first.ok());
  const absl::Status refused = OwnerLock::Acquire(directory / "owner").status();
  EXPECT_TRUE(absl::IsUnavailable(refused));
  EXPECT_THAT(std::string(refused.message()), testing::HasSubstr(std::to_string(getpid())));
}

TEST(OwnerLockTest, TheLockIsFreeOnceItsOwnerIsGone) {
  TemporaryDirectory directory;
  { ASSERT_TRUE(OwnerLock::Acquire(directory / "owner").ok()); }
  EXPECT_TRUE(OwnerLock::Acquire(directory / "owner").ok());
}

TEST(OwnerLockTest, AnOwnerThatIsEndingIsWaitedFor) {
  TemporaryDirectory directory;
  std::optional<absl::StatusOr<OwnerLock>> first = OwnerLock::Acquire(directory / "owner");
  ASSERT_TRUE(first->ok());
  std::future<absl::StatusOr<OwnerLock>> second = std::async(std::launch::async, [&] {
    return OwnerLock::Acquire(directory / "owner", std::chrono::minutes(1));
  });
  EXPECT_EQ(second.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  first.reset();
  EXPECT_TRUE(second.get().ok());
}

}  // namespace
}  // namespace cleave
