#include "client/io/series/write_aside.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

TEST(WriteAside, LeavesOnlyTheWholeFile) {
  const TemporaryDirectory directory;
  const std::string folder = directory / "deep/er";
  ASSERT_TRUE(MakeDirectories(folder).ok());
  const std::string path = folder + "/file";
  ASSERT_TRUE(WriteAside(path, "first and long").ok());
  ASSERT_TRUE(WriteAside(path, "second").ok());
  EXPECT_EQ(ReadStart(path, 100), "second");
  EXPECT_EQ(ReadStart(path, 3), "sec");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(WriteAside, AMissingFolderIsAStatusWithThePath) {
  const absl::Status status = WriteAside("/nowhere/at/all", "x");
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), HasSubstr("/nowhere/at/all"));
  EXPECT_EQ(ReadStart("/nowhere/at/all", 10), "");
}

}  // namespace
}  // namespace cleave
