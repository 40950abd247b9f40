#include "server/session/reports.h"

#include <gtest/gtest.h>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

const char kThree[] =
    "{\"frame\":1,\"time\":1}\n{\"frame\":2,\"time\":2}\n{\"frame\":3,\"time\":3}\n";

TEST(ReportsTest, LinesAreAppended) {
  TemporaryDirectory directory;
  absl::StatusOr<Reports> reports = Reports::Open(directory / "r", 0);
  ASSERT_TRUE(reports.ok());
  ASSERT_TRUE(reports->Append(1, "{\"frame\":1}").ok());
  ASSERT_TRUE(reports->Append(2, "{\"frame\":2}").ok());
  EXPECT_EQ(ReadBytes(directory / "r"), "{\"frame\":1}\n{\"frame\":2}\n");
}

TEST(ReportsTest, LinesOfFramesAfterTheHeadAreCut) {
  TemporaryDirectory directory;
  WriteBytes(directory / "r", kThree);
  absl::StatusOr<Reports> reports = Reports::Open(directory / "r", 2);
  ASSERT_TRUE(reports.ok());
  EXPECT_EQ(reports->last_frame(), 2);
  EXPECT_EQ(ReadBytes(directory / "r"), std::string(kThree).substr(0, 42));
}

TEST(ReportsTest, AFileTornAtAnyByteKeepsItsWholeLines) {
  TemporaryDirectory directory;
  const std::string bytes = kThree;
  for (size_t size = 0; size <= bytes.size(); ++size) {
    WriteBytes(directory / "r", bytes.substr(0, size));
    absl::StatusOr<Reports> reports = Reports::Open(directory / "r", 100);
    ASSERT_TRUE(reports.ok());
    ASSERT_EQ(reports->last_frame(), static_cast<int64_t>(size / 21)) << size;
    ASSERT_EQ(ReadBytes(directory / "r"), bytes.substr(0, size / 21 * 21));
  }
}

}  // namespace
}  // namespace cleave
