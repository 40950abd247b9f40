#include "client/cli/number_check.h"

#include <gtest/gtest.h>

#include <string>

namespace cleave {
namespace {

std::string FaultOf(const CLI::Validator& check, std::string text) { return check(text); }

TEST(NumberCheckTest, FaultTellsValueAndRange) {
  EXPECT_EQ(FaultOf(NumberWithin(1e-15, 1e9), "0"), "0 is outside [1e-15, 1e+09]");
  EXPECT_EQ(FaultOf(NumberAbove(0, 100), "0"), "0 is outside (0, 100]");
  EXPECT_EQ(FaultOf(CountWithin(1, 400), "401"), "401 is outside [1, 400]");
}

TEST(NumberCheckTest, NanAndInfinityAreOutsideOfEveryRange) {
  for (const char* text : {"nan", "-nan", "inf", "-inf", "1e999"}) {
    EXPECT_NE(FaultOf(NumberWithin(-1e300, 1e300), text), "") << text;
    EXPECT_NE(FaultOf(NumberAbove(-1e300, 1e300), text), "") << text;
    EXPECT_NE(FaultOf(CountWithin(-1000, 1000), text), "") << text;
  }
}

TEST(NumberCheckTest, BoundsAreAllowedButForAnOpenOne) {
  EXPECT_EQ(FaultOf(NumberWithin(-2, 3), "-2"), "");
  EXPECT_EQ(FaultOf(NumberWithin(-2, 3), "3"), "");
  EXPECT_EQ(FaultOf(NumberAbove(0, 3), "3"), "");
  EXPECT_EQ(FaultOf(NumberAbove(0, 3), "1e-300"), "");
  EXPECT_EQ(FaultOf(CountWithin(-2, 3), "-2"), "");
  EXPECT_EQ(FaultOf(CountWithin(-2, 3), "3"), "");
}

TEST(NumberCheckTest, WhatIsNoNumberIsNamed) {
  EXPECT_EQ(FaultOf(NumberWithin(0, 1), "half"), "\"half\" is not a number");
  EXPECT_EQ(FaultOf(CountWithin(0, 9), "1.5"), "\"1.5\" is not a whole number in [0, 9]");
}

}  // namespace
}  // namespace cleave
