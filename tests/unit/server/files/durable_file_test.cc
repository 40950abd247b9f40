#include "server/files/durable_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

TEST(DurableFileTest, WritingReplacesTheWholeFileAndLeavesNothingAside) {
  TemporaryDirectory directory;
  ASSERT_TRUE(WriteFileDurably(directory / "f", "a longer first version").ok());
  ASSERT_TRUE(WriteFileDurably(directory / "f", "second").ok());
  EXPECT_EQ(*ReadFile(directory / "f", 100), "second");
  EXPECT_FALSE(FileExists(directory / "f.tmp"));
}

TEST(DurableFileTest, AFileThatIsTooLargeIsDamageAndNotRead) {
  TemporaryDirectory directory;
  ASSERT_TRUE(WriteFileDurably(directory / "f", "12345").ok());
  EXPECT_TRUE(absl::IsDataLoss(ReadFile(directory / "f", 4).status()));
  EXPECT_TRUE(absl::IsNotFound(ReadFile(directory / "g", 4).status()));
}

TEST(DurableFileTest, AFileThatEndsTooEarlyIsDataLossAndAllocatesNothing) {
  TemporaryDirectory directory;
  ASSERT_TRUE(WriteFileDurably(directory / "f", "12345").ok());
  absl::StatusOr<FileDescriptor> file = OpenFile(directory / "f", O_RDONLY);
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(*ReadAt(*file, 1, 3, "f"), "234");
  EXPECT_TRUE(absl::IsDataLoss(ReadAt(*file, 1, int64_t{1} << 60, "f").status()));
  EXPECT_TRUE(absl::IsDataLoss(ReadAt(*file, int64_t{1} << 60, 1, "f").status()));
  EXPECT_TRUE(absl::IsDataLoss(ReadAt(*file, -1, 1, "f").status()));
  EXPECT_TRUE(absl::IsDataLoss(ReadAt(*file, 0, -1, "f").status()));
}

TEST(DurableFileTest, ErrorsNameThePath) {
  const absl::Status status = WriteFileDurably("/nowhere/at/all", "x");
  EXPECT_TRUE(absl::IsNotFound(status));
  EXPECT_NE(status.message().find("/nowhere/at/all"), absl::string_view::npos);
}

}  // namespace
}  // namespace cleave
