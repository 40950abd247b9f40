#include "core/scene/presets.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/scene/validate.h"

namespace cleave {
namespace {

TEST(MaterialPresets, AreTheMaterialsThatScenesAskFor) {
  for (const char* name : {"bread", "raw_meat", "dry_wood", "damp_wood", "porcelain", "gold",
                           "gold_copper", "cheese", "rubber", "glass", "concrete"}) {
    ASSERT_TRUE(FindMaterialPreset(name).has_value()) << name;
    EXPECT_EQ(FindMaterialPreset(name)->material.name, name);
  }
  EXPECT_FALSE(FindMaterialPreset("oak").has_value());
  EXPECT_FALSE(FindMaterialPreset("").has_value());
}

TEST(MaterialPresets, PassTheRulesOfAScene) {
  for (const MaterialPreset& preset : MaterialPresets()) {
    Scene scene;
    BoxMesh box;
    box.size = {1, 1, 1};
    box.resolution.cell_size = 0.25;
    scene.mesh.source = box;
    scene.materials = {preset.material};
    const Faults faults = ValidateScene(scene);
    EXPECT_TRUE(faults.ok()) << preset.material.name << ": " << faults.ToStatus();
    EXPECT_EQ(faults.warning_count(), 0) << preset.material.name;
  }
}

TEST(MaterialPresets, HaveNamesOfTheirOwnAndSources) {
  std::set<std::string> names;
  for (const MaterialPreset& preset : MaterialPresets()) {
    EXPECT_TRUE(names.insert(preset.material.name).second) << preset.material.name;
    EXPECT_FALSE(preset.description.empty());
    EXPECT_FALSE(preset.sources.empty());
    EXPECT_TRUE(preset.material.tensile_strength.has_value());
    EXPECT_TRUE(preset.material.regions.empty());
  }
}

}  // namespace
}  // namespace cleave
