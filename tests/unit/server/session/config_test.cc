#include "server/session/config.h"

#include <gtest/gtest.h>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

TEST(ConfigTest, WhatWasCreatedIsRead) {
  TemporaryDirectory directory;
  const SessionPaths paths{directory / "s"};
  worker::v1::SessionConfig config;
  config.set_uid("u-1");
  config.mutable_scene()->mutable_mesh()->set_asset(std::string(64, 'a'));
  ASSERT_TRUE(CreateSessionDirectory(paths, config).ok());
  const absl::StatusOr<worker::v1::SessionConfig> read = ReadSessionConfig(paths);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->SerializeAsString(), config.SerializeAsString());
}

TEST(ConfigTest, ADamagedConfigIsDataLossAtEveryByte) {
  TemporaryDirectory directory;
  const SessionPaths paths{directory / "s"};
  worker::v1::SessionConfig config;
  config.set_uid("u-1");
  ASSERT_TRUE(CreateSessionDirectory(paths, config).ok());
  const std::string bytes = ReadBytes(paths.config());
  for (size_t i = 0; i < bytes.size(); ++i) {
    WriteBytes(paths.config(), bytes.substr(0, i));
    ASSERT_TRUE(absl::IsDataLoss(ReadSessionConfig(paths).status())) << i;
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    WriteBytes(paths.config(), damaged);
    ASSERT_TRUE(absl::IsDataLoss(ReadSessionConfig(paths).status())) << i;
  }
}

TEST(ConfigTest, ADirectoryWithoutConfigIsNotFound) {
  TemporaryDirectory directory;
  EXPECT_TRUE(absl::IsNotFound(ReadSessionConfig({directory.path()}).status()));
}

TEST(ConfigTest, AnAssetInTheDirectoryGoesBeforeTheSharedOne) {
  TemporaryDirectory directory;
  std::filesystem::create_directories(directory / "sessions/s/assets");
  std::filesystem::create_directories(directory / "assets");
  const SessionPaths paths{directory / "sessions/s"};
  EXPECT_TRUE(absl::IsNotFound(FindSessionAsset(paths, "d").status()));
  WriteBytes(directory / "assets/d", "shared");
  EXPECT_EQ(ReadBytes(*FindSessionAsset(paths, "d")), "shared");
  WriteBytes(directory / "sessions/s/assets/d", "own");
  EXPECT_EQ(ReadBytes(*FindSessionAsset(paths, "d")), "own");
}

}  // namespace
}  // namespace cleave
