#include "server/session/owner_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

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

}  // namespace
}  // namespace cleave
