#include "client/cli/material_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

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
  const TemporaryDirectory directory;
  const std::string path = directory / "two.scene.textproto";
  WriteBytes(path,
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
  const TemporaryDirectory directory;
  const std::string path = directory / "clay.material.json";
  WriteBytes(path, "{\n  \"youngs_modulus\": 1e6,\n  \"density\": -1\n}\n");
  const auto input = LoadMaterial(path, "");
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_EQ(input->material.youngs_modulus(), 1e6);
  EXPECT_EQ(std::string(input->Describe({{"material.density", "is odd"}}).message()),
            absl::StrCat(path, ":3: density: is odd"));
  EXPECT_TRUE(absl::IsNotFound(LoadMaterial("none.material.json", "").status()));
}

}  // namespace
}  // namespace cleave
