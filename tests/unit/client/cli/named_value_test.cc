#include "client/cli/named_value.h"

#include <gtest/gtest.h>

#include <string>

namespace cleave {
namespace {

enum class Fruit { kApple = 4, kPear = 7 };

TEST(NamedValue, NamesBecomeValuesAndOthersAreToldWhatThereIs) {
  const CLI::Validator transform =
      NamedValue<Fruit>({{"pear", Fruit::kPear}, {"apple", Fruit::kApple}});
  std::string text = "pear";
  EXPECT_EQ(transform(text), "");
  EXPECT_EQ(text, "7");
  for (const std::string other : {"plum", "7", ""}) {
    text = other;
    EXPECT_EQ(transform(text), other + " is none of apple, pear");
    EXPECT_EQ(text, other);
  }
}

}  // namespace
}  // namespace cleave
