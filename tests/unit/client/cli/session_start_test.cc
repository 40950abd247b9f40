#include "client/cli/session_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(NewSessionId, IsValidForAnyFileNameAndDiffersEachTime) {
  for (const std::string& path :
       {std::string("scenes/Notched_Rod.scene.json"), std::string("7.json"), std::string(".json"),
        std::string("___"), std::string("b\xC3\xA4r.textproto"), std::string(500, 'x') + ".json"}) {
    const std::string id = NewSessionId(path);
    EXPECT_THAT(id, testing::MatchesRegex("[a-z][a-z0-9-]+"));
    EXPECT_LE(id.size(), 63u);
    EXPECT_GE(id.size(), 3u);
    EXPECT_NE(id, NewSessionId(path));
  }
  EXPECT_THAT(NewSessionId("scenes/Notched_Rod.scene.json"), testing::StartsWith("notched-rod-"));
}

}  // namespace
}  // namespace cleave
