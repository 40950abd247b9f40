#include "server/gateway/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace cleave {
namespace {

absl::StatusOr<GatewayOptions> Parse(std::vector<const char*> words) {
  words.insert(words.begin(), {"cleaved", "--worker=/bin/true"});
  return ParseGatewayOptions(static_cast<int>(words.size()), words.data());
}

TEST(OptionsTest, FlagsTakeTheirValueEitherWay) {
  const auto options = Parse({"--listen", "unix:/tmp/s", "--data=/tmp/d", "--pool-threads", "2"});
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(options->listen, "unix:/tmp/s");
  EXPECT_EQ(options->data, "/tmp/d");
  EXPECT_EQ(options->pool_threads, 2);
  EXPECT_EQ(options->workers.program, "/bin/true");
}

TEST(OptionsTest, PlaintextBeyondThisMachineNeedsAWord) {
  for (const char* address : {"127.0.0.1:5000", "localhost:5000", "[::1]:5000", "127.1.2.3:1"}) {
    EXPECT_TRUE(Parse({"--listen", address, "--data", "d"}).ok()) << address;
  }
  for (const char* address : {"0.0.0.0:5000", "[::]:5000", "10.0.0.1:5000", "example.org:1"}) {
    EXPECT_FALSE(Parse({"--listen", address, "--data", "d"}).ok()) << address;
    EXPECT_TRUE(Parse({"--listen", address, "--data", "d", "--insecure"}).ok()) << address;
  }
}

TEST(OptionsTest, WhatIsWrongIsNamed) {
  const std::string long_path = "unix:/" + std::string(200, 'x');
  const std::vector<std::vector<const char*>> wrong = {
      {"--data", "d"},
      {"--listen", "unix:/tmp/s"},
      {"--listen", "nonsense", "--data", "d"},
      {"--listen", "localhost:99999", "--data", "d"},
      {"--listen", long_path.c_str(), "--data", "d"},
      {"--listen", "unix:", "--data", "d"},
      {"--listen", "unix:/tmp/s", "--data", "d", "--pool-threads", "0"},
      {"--listen", "unix:/tmp/s", "--data", "d", "--pool-threads"},
      {"--listen", "unix:/tmp/s", "--data", "d", "--colour", "red"},
      {"--listen", "unix:/tmp/s", "--data", "d", "--worker", "/nowhere/worker"},
      {"stray"}};
  for (const auto& words : wrong) {
    EXPECT_TRUE(absl::IsInvalidArgument(Parse(words).status())) << words.back();
  }
}

}  // namespace
}  // namespace cleave
