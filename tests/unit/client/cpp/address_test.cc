#include "client/cpp/address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(Address, SocketsAndHostsBecomeTargets) {
  EXPECT_EQ(ParseAddress("unix:/tmp/s").value(), "unix:/tmp/s");
  EXPECT_EQ(ParseAddress("unix:///tmp/s").value(), "unix:/tmp/s");
  EXPECT_EQ(ParseAddress("unix:here/s").value(), "unix:here/s");
  EXPECT_EQ(ParseAddress("farm-3:7420").value(), "dns:///farm-3:7420");
  EXPECT_EQ(ParseAddress("[::1]:7420").value(), "dns:///[::1]:7420");
}

TEST(Address, EveryOtherFormIsRefusedWithBothForms) {
  for (const char* wrong :
       {"", "localhost", "localhost:", "localhost:0", "localhost:65536", "localhost:http", ":7420",
        "::1:7420", "http://a:1", "unix:", "a b:1", "unix://tmp/s"}) {
    const auto result = ParseAddress(wrong);
    ASSERT_TRUE(absl::IsInvalidArgument(result.status())) << wrong;
    EXPECT_THAT(std::string(result.status().message()),
                testing::AllOf(testing::HasSubstr("HOST:PORT"), testing::HasSubstr("unix:/")));
  }
}

TEST(Address, SocketPathThatNoSocketCanHaveIsRefused) {
  EXPECT_TRUE(ParseAddress("unix:/" + std::string(106, 'a')).ok());
  EXPECT_FALSE(ParseAddress("unix:/" + std::string(107, 'a')).ok());
}

}  // namespace
}  // namespace cleave
