#include "client/io/scene/json_scanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cleave {
namespace {

using testing::HasSubstr;

std::string ErrorOf(absl::string_view text) {
  JsonScanner scanner(text);
  if (scanner.SkipValue()) scanner.ReadEnd();
  return scanner.error();
}

TEST(JsonScanner, AcceptsWhatTheGrammarAllows) {
  for (const char* text : {"{}", "[]", " [1, -0, 0.5, 1e9, 1E-9, 12.5e+3] ", "\"\\u00e4\\n\\/\"",
                           "{\"a\": {\"b\": [true, false, null]}}", "\xEF\xBB\xBF{}"})
    EXPECT_EQ(ErrorOf(text), "") << text;
}

TEST(JsonScanner, RefusesWhatItDoesNot) {
  for (const char* text : {"",          "{",       "[1,]",        "{\"a\":1,}",  "[1 2]",
                           "{\"a\" 1}", "{a: 1}",  "01",          "1.",          ".5",
                           "+1",        "1e",      "0x10",        "NaN",         "'a'",
                           "\"a",       "\"\\x\"", "\"\\ud800\"", "\"\\udc00\"", "\"a\nb\"",
                           "[}",        "{} {}",   "[1] // note", "tru",         "-"})
    EXPECT_NE(ErrorOf(text), "") << text;
}

TEST(JsonScanner, CommentsAreRefusedWithTheWayOut) {
  EXPECT_THAT(ErrorOf("{ // note\n }"), HasSubstr("textproto"));
  EXPECT_THAT(ErrorOf("{\"a\": /* note */ 1}"), HasSubstr("textproto"));
  EXPECT_THAT(ErrorOf("{\"a\": 1 // note\n}"), HasSubstr("textproto"));
}

TEST(JsonScanner, LinesAreThoseOfTheText) {
  JsonScanner scanner("{\n\n \"a\"\n:\n 1}");
  JsonScanner::Cursor cursor;
  std::string key;
  ASSERT_TRUE(scanner.BeginObject());
  ASSERT_TRUE(scanner.NextMember(cursor, key));
  EXPECT_EQ(key, "a");
  EXPECT_EQ(scanner.Peek(), JsonScanner::Kind::kNumber);
  EXPECT_EQ(scanner.line(), 5);
}

TEST(JsonScanner, SurrogatePairIsOneCharacter) {
  JsonScanner scanner("\"\\ud83d\\ude00\"");
  std::string value;
  ASSERT_TRUE(scanner.ReadString(value));
  EXPECT_EQ(value, "\xF0\x9F\x98\x80");
}

TEST(JsonScanner, DeepNestingIsRefusedNotFollowed) {
  EXPECT_THAT(ErrorOf(std::string(1'000'000, '[')), HasSubstr("nested deeper"));
}

}  // namespace
}  // namespace cleave
