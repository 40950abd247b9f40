#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "core/scene/limits.h"
#include "core/scene/render_mesh_rules.h"
#include "core/scene/validate.h"
#include "proto/convert/mesh.h"
#include "proto/convert/scene.h"
#include "tests/mutation/mutate.h"

namespace cleave {
namespace {

v1::Scene BundledScene() {
  std::ifstream file(CLEAVE_SOURCE_DIR "/tests/scenes/tensile_bar.scene.json");
  std::stringstream text;
  text << file.rdbuf();
  v1::Scene scene;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(text.str(), &scene).ok());
  scene.mutable_mesh()->set_asset(std::string(64, 'a'));
  scene.mutable_render_mesh()->set_asset(std::string(64, 'b'));
  return scene;
}

TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

// What a scene that validation lets through must be, said again in other words than validate.cc.
void ExpectSound(const Scene& scene) {
  ASSERT_FALSE(scene.materials.empty());
  for (const Material& material : scene.materials) {
    EXPECT_TRUE(std::isfinite(material.youngs_modulus) && material.youngs_modulus > 0);
    EXPECT_TRUE(material.poisson_ratio >= 0 && material.poisson_ratio < 0.5);
    EXPECT_TRUE(std::isfinite(material.density) && material.density > 0);
    EXPECT_FALSE(material.tensile_strength.has_value() && std::isnan(*material.tensile_strength));
  }
  for (const Motion& motion : scene.motions) {
    for (const Keyframe& keyframe : motion.keyframes) {
      EXPECT_TRUE(std::isfinite(keyframe.time) && std::isfinite(keyframe.rotation));
      for (const double x : keyframe.translation) EXPECT_TRUE(std::isfinite(x));
    }
  }
  if (scene.gravity.has_value()) {
    for (const double g : *scene.gravity) EXPECT_TRUE(std::isfinite(g));
  }
  const double dt = 1 / (scene.timing.frames_per_second * scene.timing.steps_per_frame);
  EXPECT_TRUE(dt > 0 && dt <= 10);
  EXPECT_GE(scene.timing.frame_count, 1);
}

TEST(MutatedScenes, AreRefusedByFieldOrSound) {
  const v1::Scene original = BundledScene();
  const TetMesh mesh = OneTet();
  const google::protobuf::LogSilencer quiet;
  int accepted = 0, refused = 0;
  for (uint64_t seed = 0; seed < 10000; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    v1::Scene message = original;
    if (dice.OneIn(2)) {
      MutateMessage(message, dice);
    } else if (!message.ParseFromString(MutateBytes(original.SerializeAsString(), dice))) {
      continue;
    }
    Faults faults;
    const Scene scene = SceneFromMessage(message, faults);
    faults.Append("", ValidateScene(scene));
    if (!faults.ok()) {
      ++refused;
      ASSERT_FALSE(faults.errors().empty());
      for (const Fault& fault : faults.errors()) {
        EXPECT_FALSE(fault.field.empty());
        EXPECT_FALSE(fault.description.empty());
      }
      continue;
    }
    ++accepted;
    ExpectSound(scene);
    ValidateSceneWithMesh(scene, mesh);
  }
  // Both kinds must have been met, or the test shows nothing.
  EXPECT_GT(accepted, 100);
  EXPECT_GT(refused, 1000);
}

TEST(MutatedRenderMeshes, AreRefusedOrAsSoundAsTheirRulesSay) {
  RenderMesh mesh;
  mesh.points = OneTet().rest_positions;
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  mesh.uvs.resize(4);
  const std::string original = *SerializeRenderMesh(mesh);
  int sound = 0;
  for (uint64_t seed = 0; seed < 10000; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    const auto mutant = ParseRenderMesh(MutateBytes(original, dice));
    if (!mutant.ok() || !CheckRenderMesh(*mutant).ok() ||
        !CheckRenderMeshFits(*mutant, mesh.points).ok())
      continue;
    ++sound;
    EXPECT_TRUE(mutant->uvs.empty() || mutant->uvs.size() == mutant->triangles.size());
    for (const auto& triangle : mutant->triangles) {
      for (const int32_t point : triangle)
        EXPECT_TRUE(point >= 0 && static_cast<size_t>(point) < mutant->points.size());
    }
    for (const Vec3& point : mutant->points) {
      for (const double coordinate : point) EXPECT_LE(std::abs(coordinate), 2);
    }
  }
  EXPECT_GT(sound, 100);
}

TEST(MutatedMeshes, AreRefusedOrKeepTheirListsInStep) {
  const std::string original = *SerializeMesh(OneTet());
  int parsed = 0;
  for (uint64_t seed = 0; seed < 10000; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    const auto mesh = ParseMesh(MutateBytes(original, dice));
    if (!mesh.ok()) continue;
    ++parsed;
    EXPECT_TRUE(mesh->tet_regions.empty() || mesh->tet_regions.size() == mesh->tets.size());
  }
  EXPECT_GT(parsed, 100);
}

}  // namespace
}  // namespace cleave
