#include "client/cli/json_line.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cleave {
namespace {

TEST(JsonLine, MembersKeepTheirOrderAndTypes) {
  EXPECT_EQ(JsonLine()
                .Add("name", "rod")
                .Add("frame", int64_t{12})
                .Add("time", 0.25)
                .Add("done", true)
                .AddJson("list", JsonList({"1", "2"}))
                .Str(),
            "{\"name\":\"rod\",\"frame\":12,\"time\":0.25,\"done\":true,\"list\":[1,2]}");
  EXPECT_EQ(JsonLine().Str(), "{}");
}

TEST(JsonLine, TextIsEscapedAndStaysOnOneLine) {
  EXPECT_EQ(JsonString("a\"b\\c\nd\te\x01"), "\"a\\\"b\\\\c\\nd\\u0009e\\u0001\"");
}

TEST(JsonLine, WhatJsonHasNoNumberForIsNull) {
  EXPECT_EQ(JsonNumber(NAN), "null");
  EXPECT_EQ(JsonNumber(-INFINITY), "null");
  EXPECT_EQ(JsonNumber(1e-300), "1e-300");
}

}  // namespace
}  // namespace cleave
