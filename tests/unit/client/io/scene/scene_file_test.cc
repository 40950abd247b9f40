#include "client/io/scene/scene_file.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "absl/strings/str_cat.h"
#include "tests/unit/client/io/scene/full_scene.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using google::protobuf::util::MessageDifferencer;
using testing::HasSubstr;
using testing::Not;

std::string JsonError(absl::string_view text) {
  return std::string(ParseScene(text, SceneFormat::kJson, "notched.scene.json").status().message());
}
std::string TextError(absl::string_view text) {
  return std::string(ParseScene(text, SceneFormat::kText, "notched.textproto").status().message());
}

TEST(SceneFile, JsonGivesTheMessageThatProtobufGives) {
  const auto file = ParseScene(kFullScene, SceneFormat::kJson, "full.scene.json");
  ASSERT_TRUE(file.ok()) << file.status();
  v1::Scene expected;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(kFullScene, &expected).ok());
  EXPECT_TRUE(MessageDifferencer::Equals(file->scene, expected));
  EXPECT_EQ(file->scene.mesh().box().resolution().seed(), 4294967295u);
}

TEST(SceneFile, TextFormatGivesTheSameScene) {
  const auto json = ParseScene(kFullScene, SceneFormat::kJson, "full.scene.json");
  ASSERT_TRUE(json.ok()) << json.status();
  const auto text = ParseScene("# a note\n" + json->scene.DebugString(), SceneFormat::kText, "a");
  ASSERT_TRUE(text.ok()) << text.status();
  EXPECT_TRUE(MessageDifferencer::Equals(json->scene, text->scene));
}

TEST(SceneFile, UnknownFieldNamesTheNearestAndTheLine) {
  EXPECT_EQ(JsonError("{\n \"materials\": [{\n  \"youngs_moduls\": 1\n }]}"),
            "notched.scene.json:3: material field \"youngs_moduls\" is unknown; "
            "did you mean \"youngs_modulus\"?");
  EXPECT_EQ(TextError("materials {\n  youngs_moduls: 1\n}"),
            "notched.textproto:2: material field \"youngs_moduls\" is unknown; "
            "did you mean \"youngs_modulus\"?");
}

TEST(SceneFile, AllFaultsComeAtOnceInOrderOfLines) {
  EXPECT_EQ(JsonError("{\"nmae\": \"a\",\n\"timing\": {\"frame_count\": 1.5,\n"
                      "\"steps_per_frame\": \"many\"},\n\"gravity\": [0, \"down\", true],\n"
                      "\"seed\": -1,\n\"motions\": [{\"axes\": [\"X\"]}],\n\"materials\": {}}"),
            "notched.scene.json:1: scene field \"nmae\" is unknown; did you mean \"name\"?\n"
            "notched.scene.json:2: timing.frame_count: 1.5 is not a whole number\n"
            "notched.scene.json:3: timing.steps_per_frame: many is not a whole number\n"
            "notched.scene.json:4: gravity[1]: \"down\" is not a number\n"
            "notched.scene.json:4: gravity[2]: true or false is not a number\n"
            "notched.scene.json:5: seed: -1 is outside [0, 4294967295]\n"
            "notched.scene.json:6: motions[0].axes[0]: \"X\" is unknown; did you mean \"AXIS_X\"?\n"
            "notched.scene.json:7: materials: an object { } is not a list [ ]");
}

TEST(SceneFile, TextFormatReportsAllUnknownFields) {
  const std::string error = TextError("nmae: 'a'\ntiming { frames: 3 }\nseed: 1");
  EXPECT_THAT(error, HasSubstr("notched.textproto:1: scene field \"nmae\""));
  EXPECT_THAT(error, HasSubstr("notched.textproto:2: timing field \"frames\""));
}

TEST(SceneFile, FieldsGivenTwiceAndRivalsAreRefused) {
  EXPECT_THAT(JsonError("{\"seed\": 1, \"seed\": 2}"), HasSubstr("seed: is given twice"));
  EXPECT_THAT(JsonError("{\"timing\":{\"frameCount\": 1, \"frame_count\": 2}}"),
              HasSubstr("timing.frame_count: is given twice"));
  EXPECT_THAT(JsonError("{\"mesh\": {\"file\": \"a.msh\", \"box\": {}}}"),
              HasSubstr("mesh.box: excludes \"file\""));
}

TEST(SceneFile, NumbersThatAreNoneAreRefused) {
  EXPECT_THAT(JsonError("{\"gravity\": [1e999]}"), HasSubstr("too large"));
  EXPECT_THAT(JsonError("{\"gravity\": [NaN]}"), HasSubstr("not a JSON value"));
  EXPECT_THAT(JsonError("{\"gravity\": [\"NaN\"]}"), HasSubstr("is not a number"));
  EXPECT_THAT(JsonError("{\"timing\": {\"frame_count\": 9223372036854775808}}"),
              HasSubstr("is outside"));
  EXPECT_THAT(JsonError("{\"gravity\": [\"inf\"]}"),
              HasSubstr("\"inf\" is not a number; write \"Infinity\""));
  EXPECT_THAT(TextError("gravity: [0,\n nan]"), HasSubstr("gravity[1]"));
}

TEST(SceneFile, BytesAreBase64AndFloatsNumbers) {
  const std::string json = R"({"impurities": {"layers": [{"paint": {"texture":
    {"values": "AP8z", "uvs": [0.25, 1e-3, "Infinity"]}}}]}})";
  const auto file = ParseScene(json, SceneFormat::kJson, "a.scene.json");
  ASSERT_TRUE(file.ok()) << file.status();
  v1::Scene expected;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(json, &expected).ok());
  EXPECT_TRUE(MessageDifferencer::Equals(file->scene, expected));
  EXPECT_EQ(file->scene.impurities().layers(0).paint().texture().values(),
            std::string("\0\xff\x33", 3));
  const std::string text = expected.DebugString();
  EXPECT_TRUE(ParseScene(text, SceneFormat::kText, "a.textproto").ok()) << text;
  EXPECT_THAT(JsonError(R"({"impurities": {"layers": [{"paint": {"texture": {"values": "?"}}}]}})"),
              HasSubstr("\"?\" is not base64"));
  EXPECT_THAT(JsonError(R"({"impurities": {"layers": [{"paint": {"texture": {"uvs": [1e39]}}}]}})"),
              HasSubstr("too large"));
}

TEST(SceneFile, InfinityIsANumberOfBothFormats) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::string json = R"({"impurities": {"layers": [{"weakening": "Infinity"}]},
    "weakenings": [{"factor": "Infinity"}], "gravity": ["-Infinity"]})";
  const auto of_json = ParseScene(json, SceneFormat::kJson, "a.scene.json");
  ASSERT_TRUE(of_json.ok()) << of_json.status();
  EXPECT_EQ(of_json->scene.impurities().layers(0).weakening(), kInfinity);
  EXPECT_EQ(of_json->scene.weakenings(0).factor(), kInfinity);
  EXPECT_EQ(of_json->scene.gravity(0), -kInfinity);
  const std::string text = of_json->scene.DebugString();
  const auto of_text = ParseScene(text, SceneFormat::kText, "a.textproto");
  ASSERT_TRUE(of_text.ok()) << of_text.status();
  EXPECT_TRUE(MessageDifferencer::Equals(of_text->scene, of_json->scene)) << text;
  std::string written;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(of_text->scene, &written).ok());
  const auto again = ParseScene(written, SceneFormat::kJson, "a.scene.json");
  ASSERT_TRUE(again.ok()) << again.status() << written;
  EXPECT_TRUE(MessageDifferencer::Equals(again->scene, of_json->scene)) << written;
}

TEST(SceneFile, WrongSyntaxNamesTheLine) {
  EXPECT_EQ(JsonError("{\n\"seed\": 1\n\"name\": \"a\"}"),
            "notched.scene.json:3: ',' or '}' is missing");
  EXPECT_THAT(JsonError("[]"), HasSubstr("one JSON object"));
  EXPECT_THAT(JsonError(""), HasSubstr("notched.scene.json:1: the file ends"));
  EXPECT_THAT(JsonError("{\"name\": \"\xff\"}"), HasSubstr("not UTF-8"));
  EXPECT_THAT(TextError("name: \"\\xff\""), HasSubstr("not UTF-8"));
  EXPECT_THAT(TextError("name 1 {"), HasSubstr("notched.textproto:1"));
}

TEST(SceneFile, UnknownDeepNestingCostsNothing) {
  std::string deep;
  for (int i = 0; i < 1'000'000; ++i) deep += "a{";
  EXPECT_THAT(TextError(deep), HasSubstr("nested deeper"));
}

TEST(SceneFile, FaultsOfTheSceneFindTheirLines) {
  const std::string json = "{\n \"materials\": [\n  {},\n  {\n   \"density\": 1\n  }\n ]}";
  const auto file = ParseScene(json, SceneFormat::kJson, "a.scene.json");
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(file->LineOf("materials[1].density"), 5);
  EXPECT_EQ(file->LineOf("materials[1].poisson_ratio"), 4);
  EXPECT_EQ(file->LineOf("timing"), 0);
  EXPECT_EQ(file->Describe({{"materials[1].density", "1 is too low"}, {"mesh", "is missing"}}),
            "a.scene.json:5: materials[1].density: 1 is too low\na.scene.json: mesh: is missing");
  const auto text =
      ParseScene("seed: 1\nmaterials {}\nmaterials {\n density: 1 }", SceneFormat::kText, "a");
  ASSERT_TRUE(text.ok()) << text.status();
  EXPECT_EQ(text->LineOf("materials[1].density"), 4);
  EXPECT_EQ(text->LineOf("materials[1].poisson_ratio"), 3);
}

TEST(SceneFile, MeshFileIsBesideTheSceneFile) {
  SceneFile file;
  file.path = "scenes/a.scene.json";
  EXPECT_EQ(MeshPath(file), "");
  file.scene.mutable_mesh()->set_file("../meshes/rod.msh");
  EXPECT_EQ(MeshPath(file), "meshes/rod.msh");
  file.scene.mutable_mesh()->set_file("/data/rod.msh");
  EXPECT_EQ(MeshPath(file), "/data/rod.msh");
}

class SceneFileOnDisk : public testing::Test {
 protected:
  std::string Write(const std::string& name, absl::string_view text) {
    const std::string path = absl::StrCat(folder_, "/", name);
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  const TemporaryDirectory directory_;
  const std::string folder_ = directory_.path();
};

TEST_F(SceneFileOnDisk, NameDecidesTheFormat) {
  EXPECT_TRUE(ReadSceneFile(Write("a.scene.json", "{\"seed\": 1}")).ok());
  EXPECT_TRUE(ReadSceneFile(Write("a.textproto", "seed: 1")).ok());
  EXPECT_THAT(std::string(ReadSceneFile(Write("a.yaml", "seed: 1")).status().message()),
              HasSubstr(".textproto"));
}

TEST_F(SceneFileOnDisk, MissingFolderAndOversizeAreNamed) {
  EXPECT_TRUE(absl::IsNotFound(ReadSceneFile(folder_ + "/none.scene.json").status()));
  std::filesystem::create_directories(folder_ + "/folder.json");
  EXPECT_THAT(std::string(ReadSceneFile(folder_ + "/folder.json").status().message()),
              HasSubstr("is a folder"));
  const auto huge = ReadSceneFile(Write("huge.json", std::string(kMaxSceneFileBytes + 5, ' ')));
  EXPECT_THAT(std::string(huge.status().message()), HasSubstr("larger than 16 MiB"));
}

}  // namespace
}  // namespace cleave
