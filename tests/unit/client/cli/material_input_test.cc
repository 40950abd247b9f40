#include "client/cli/material_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

std::string Written(const std::string& name, const std::string& text) {
  const std::string path = absl::StrCat(testing::TempDir(), getpid(), ".", name);
  std::ofstream(path) << text;
  return path;
}

std::string MessageOf(const absl::StatusOr<MaterialInput>& input) {
  return std::string(input.status().message());
}

TEST(MaterialInput, IsAPresetByName) {
  const auto input = LoadMaterial("glass", "");
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_EQ(input->material.preset(), "glass");
  EXPECT_THAT(MessageOf(LoadMaterial("damp_wod", "")), HasSubstr("did you mean \"damp_wood\"?"));
  EXPECT_THAT(MessageOf(LoadMaterial("xyzzyxyzzy", "")), HasSubstr("presets: bread, cheese"));
}

TEST(MaterialInput, IsAMaterialOfASceneByNameOrIndex) {
  const std::string path = Written("two.scene.textproto",
                                   "materials { name: \"core\" density: 1 }\n"
                                   "materials { preset: \"rubber\" density: 2 }\n"
                                   "fracture { stress: FRACTURE_STRESS_TOTAL }\n");
  for (const char* which : {"rubber", "1"}) {
    const auto input = LoadMaterial(path, which);
    ASSERT_TRUE(input.ok()) << input.status();
    EXPECT_EQ(input->material.density(), 2);
    EXPECT_EQ(input->stress, v1::FRACTURE_STRESS_TOTAL);
    EXPECT_EQ(
        std::string(
            input->Describe({{"material.density", "is odd"}, {"samples", "is even"}}).message()),
        absl::StrCat(path, ":2: materials[1].density: is odd\nsamples: is even"));
  }
  EXPECT_THAT(MessageOf(LoadMaterial(path, "")),
              HasSubstr("choose one by --material; it has 0: core, 1: rubber"));
  EXPECT_THAT(MessageOf(LoadMaterial(path, "2")), HasSubstr("has no material \"2\""));
}

TEST(MaterialInput, IsAFileOfItsOwn) {
  const std::string path =
      Written("clay.material.json", "{\n  \"youngs_modulus\": 1e6,\n  \"density\": -1\n}\n");
  const auto input = LoadMaterial(path, "");
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_EQ(input->material.youngs_modulus(), 1e6);
  EXPECT_EQ(std::string(input->Describe({{"material.density", "is odd"}}).message()),
            absl::StrCat(path, ":3: density: is odd"));
  EXPECT_TRUE(absl::IsNotFound(LoadMaterial("none.material.json", "").status()));
}

}  // namespace
}  // namespace cleave
