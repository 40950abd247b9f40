#include "client/cli/session_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/cli/goal.h"
#include "client/cli/products.h"

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

TEST(GoalOptions, ACommandToGoOnHasTheOptionsThatWereTyped) {
  EXPECT_EQ(GoalOptions().Words(), "");
  EXPECT_EQ((GoalOptions{12, 0.5, true}.Words()),
            " --frames 12 --wall-budget 0.5 --until-fracture");
  EXPECT_EQ(ProductOptions().Words(), "");
  EXPECT_EQ((ProductOptions{.ply = true, .plot = true}.Words()), " --ply --plot");
}

}  // namespace
}  // namespace cleave
