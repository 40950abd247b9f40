#include "client/io/mesh/scanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cleave {
namespace {

using ::testing::HasSubstr;

TEST(Scanner, ReadsTextAcrossLinesAndComments) {
  Scanner scan("  12 -3.5e2\n# a note 99\n+7 word rest of it \r\nnext");
  scan.SetComment('#');
  EXPECT_EQ(scan.Integer("a"), 12);
  EXPECT_EQ(scan.Number("b"), -350);
  EXPECT_EQ(scan.Count("c"), 7);
  EXPECT_EQ(scan.Token("d"), "word");
  EXPECT_EQ(scan.RestOfLine(), "rest of it");
  EXPECT_EQ(scan.Token("e"), "next");
  EXPECT_TRUE(scan.AtEnd());
  EXPECT_TRUE(scan.ok());
}

TEST(Scanner, KeepsItsFirstFailure) {
  Scanner scan("1\n2 x3 4");
  scan.Integer("a");
  scan.Integer("b");
  EXPECT_EQ(scan.Integer("the third"), 0);
  EXPECT_EQ(scan.Integer("the fourth"), 0);
  EXPECT_EQ(scan.status().message(), "line 2: expected the third, found `x3`");
  EXPECT_EQ(scan.status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(Scanner, TellsTheEndAndBadNumbers) {
  Scanner end("5 ");
  end.Integer("a");
  end.Number("a coordinate");
  EXPECT_THAT(end.status().message(), HasSubstr("expected a coordinate, but the file ends"));
  Scanner negative("-4");
  negative.Count("a count");
  EXPECT_THAT(negative.status().message(), HasSubstr("found `-4`"));
  Scanner large("99999999999999999999");
  large.Integer("an integer");
  EXPECT_FALSE(large.ok());
  const std::string text(1'000'000, 'x');
  Scanner long_token(text);
  long_token.Integer("an integer");
  EXPECT_LT(long_token.status().message().size(), 200u);
}

TEST(Scanner, ReadsBinaryOfEitherOrderAndNoFurther) {
  const std::string bytes("\x01\x02\x03\x04\x00\x00\x80\x3F\x05", 9);
  Scanner scan(bytes);
  scan.SetSwapped(true);
  EXPECT_EQ(scan.Binary<int32_t>("a"), 0x01020304);
  scan.SetSwapped(false);
  EXPECT_EQ(scan.Binary<float>("b"), 1.0f);
  EXPECT_EQ(scan.Binary<double>("a double"), 0);
  EXPECT_THAT(scan.status().message(), HasSubstr("byte 8: expected a double, 8 bytes, but the file "
                                                 "ends after 1"));
}

TEST(Scanner, SkipsPastALineAndNotPastAWord) {
  Scanner scan("some $End inline\n$Ending\n $End\n$End \n7");
  scan.SkipPastLine("$End");
  EXPECT_EQ(scan.Integer("a"), 7);
  scan.SkipPastLine("$End");
  EXPECT_FALSE(scan.ok());
}

}  // namespace
}  // namespace cleave
