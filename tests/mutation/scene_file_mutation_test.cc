#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "absl/strings/match.h"
#include "client/io/scene/scene_file.h"
#include "tests/unit/client/io/scene/full_scene.h"

// Damaged scene files: every one must be refused with a reason or give exactly the scene that
// protobuf's own parser reads from it. Nothing may crash or hang.

namespace cleave {
namespace {

using google::protobuf::util::MessageDifferencer;

constexpr const char* kPieces[] = {"{",
                                   "}",
                                   "[",
                                   "]",
                                   ",",
                                   ":",
                                   "\"",
                                   "\\u",
                                   "\\",
                                   "null",
                                   "true",
                                   "1e999",
                                   "-1",
                                   "0.5",
                                   "4294967296",
                                   "NaN",
                                   "//",
                                   "#",
                                   "name",
                                   "mesh",
                                   "\"file\": \"a\",",
                                   "\"box\": {},",
                                   "\"seed\": 1,",
                                   "\"1\"",
                                   "<",
                                   ">",
                                   "'",
                                   "\xff",
                                   "\xC3\xA4",
                                   "\n",
                                   "inf",
                                   "AXIS_Y",
                                   "\"AXIS_X\"",
                                   "seed: 1 ",
                                   "1.0",
                                   "1e2"};

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string Mutate(std::string text) {
    for (size_t count = 1 + Pick(4); count > 0; --count) MutateOnce(text);
    return text;
  }

 private:
  size_t Pick(size_t count) { return count == 0 ? 0 : random_() % count; }

  void MutateOnce(std::string& text) {
    const size_t at = Pick(text.size());
    const size_t length = std::min(text.size() - at, Pick(30));
    switch (Pick(6)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random_());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(Pick(text.size()), Pick(30)));
        break;
      case 3:
        text.insert(at, kPieces[Pick(std::size(kPieces))]);
        break;
      case 4:
        text.replace(at, length, kPieces[Pick(std::size(kPieces))]);
        break;
      default:
        if (Pick(8) == 0) text.resize(at);
        break;
    }
  }

  std::mt19937 random_;
};

TEST(SceneMutation, JsonIsRefusedWithALineOrReadAsProtobufReadsIt) {
  Mutator mutator(1);
  int accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    const std::string text = mutator.Mutate(kFullScene);
    const auto file = ParseScene(text, SceneFormat::kJson, "m.json");
    if (!file.ok()) {
      ASSERT_TRUE(absl::StartsWith(file.status().message(), "m.json:")) << file.status();
      continue;
    }
    ++accepted;
    v1::Scene expected;
    const auto parsed = google::protobuf::util::JsonStringToMessage(text, &expected);
    ASSERT_TRUE(parsed.ok()) << parsed.ToString() << "\n" << text;
    ASSERT_TRUE(MessageDifferencer::Equals(file->scene, expected)) << text;
  }
  EXPECT_GT(accepted, 100);
}

TEST(SceneMutation, TextIsRefusedWithALineOrReadAsProtobufReadsIt) {
  const auto full = ParseScene(kFullScene, SceneFormat::kJson, "full.json");
  ASSERT_TRUE(full.ok()) << full.status();
  const std::string base = full->scene.DebugString();
  Mutator mutator(2);
  int accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    const std::string text = mutator.Mutate(base);
    const auto file = ParseScene(text, SceneFormat::kText, "m.textproto");
    if (!file.ok()) {
      ASSERT_TRUE(absl::StartsWith(file.status().message(), "m.textproto:")) << file.status();
      continue;
    }
    ++accepted;
    v1::Scene expected;
    ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &expected)) << text;
    ASSERT_TRUE(MessageDifferencer::Equals(file->scene, expected)) << text;
  }
  EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace cleave
