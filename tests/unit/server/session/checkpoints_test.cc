#include "server/session/checkpoints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;

std::string FileOf(const TemporaryDirectory& directory, int frame) {
  std::string digits = std::to_string(frame);
  return directory / (std::string(10 - digits.size(), '0') + digits + ".checkpoint");
}

TEST(CheckpointsTest, TheNewestTwoAreKept) {
  TemporaryDirectory directory;
  Checkpoints checkpoints(directory.path());
  for (const int frame : {10, 20, 30}) {
    ASSERT_TRUE(checkpoints.Write(frame, "state " + std::to_string(frame)).ok());
  }
  EXPECT_THAT(*checkpoints.List(), ElementsAre(30, 20));
  EXPECT_EQ(*checkpoints.Read(30), "state 30");
  EXPECT_EQ(*checkpoints.Read(20), "state 20");
}

TEST(CheckpointsTest, ADamagedOneDoesNotCountAsOneOfTheTwoThatAreKept) {
  TemporaryDirectory directory;
  Checkpoints checkpoints(directory.path());
  ASSERT_TRUE(checkpoints.Write(10, "ten").ok());
  ASSERT_TRUE(checkpoints.Write(20, "twenty").ok());
  WriteBytes(FileOf(directory, 20), "torn");
  ASSERT_TRUE(checkpoints.Write(30, "thirty").ok());
  EXPECT_THAT(*checkpoints.List(), ElementsAre(30, 20, 10));
  EXPECT_TRUE(absl::IsDataLoss(checkpoints.Read(20).status()));
  EXPECT_EQ(*checkpoints.Read(10), "ten");
}

TEST(CheckpointsTest, AFileTornOrFlippedAnywhereIsDataLoss) {
  TemporaryDirectory directory;
  Checkpoints checkpoints(directory.path());
  ASSERT_TRUE(checkpoints.Write(7, "a state of some bytes").ok());
  const std::string bytes = ReadBytes(FileOf(directory, 7));
  for (size_t size = 0; size < bytes.size(); ++size) {
    WriteBytes(FileOf(directory, 7), bytes.substr(0, size));
    ASSERT_TRUE(absl::IsDataLoss(checkpoints.Read(7).status())) << size;
  }
  for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    WriteBytes(FileOf(directory, 7), damaged);
    ASSERT_TRUE(absl::IsDataLoss(checkpoints.Read(7).status())) << bit;
  }
}

TEST(CheckpointsTest, AFileUnderAnotherFramesNameIsDataLoss) {
  TemporaryDirectory directory;
  Checkpoints checkpoints(directory.path());
  ASSERT_TRUE(checkpoints.Write(7, "seven").ok());
  WriteBytes(FileOf(directory, 8), ReadBytes(FileOf(directory, 7)));
  EXPECT_TRUE(absl::IsDataLoss(checkpoints.Read(8).status()));
}

TEST(CheckpointsTest, ForeignFilesAreNotListed) {
  TemporaryDirectory directory;
  Checkpoints checkpoints(directory.path());
  ASSERT_TRUE(checkpoints.Write(7, "seven").ok());
  WriteBytes(directory / "README", "hello");
  WriteBytes(directory / "x.checkpoint", "hello");
  WriteBytes(directory / "0000000009.checkpoint.tmp", "half");
  EXPECT_THAT(*checkpoints.List(), ElementsAre(7));
}

}  // namespace
}  // namespace cleave
