#include "client/io/preview/scene_look.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(SceneLook, RegionsOfOneMaterialShareItsNameAndColor) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1, 2, 3}};
  mesh.tet_regions = {1, 2, 3};
  mesh.regions = {{1, "left"}, {2, "middle"}, {3, "right"}};
  Scene scene;
  scene.name = "bar";
  scene.gravity = Vec3{0, -9.81, 0};
  scene.materials.resize(2);
  scene.materials[0].name = "gel";
  scene.materials[1].regions = {"left", "3"};
  scene.colliders.resize(2);
  scene.colliders[0].shape = PlaneShape{};
  scene.colliders[1].shape = SphereShape{{0, 0, 0}, 1};
  PreviewOptions options;
  options.title = "old";
  options.regions[7].label = "old";
  options.width = 321;
  ApplySceneLook(scene, mesh, options);
  EXPECT_EQ(options.title, "bar");
  EXPECT_EQ(options.width, 321);
  EXPECT_EQ(options.camera.up, (Vec3{0, 9.81, 0}));
  ASSERT_EQ(options.regions.size(), 3u);
  EXPECT_EQ(options.regions[2].label, "gel");
  EXPECT_EQ(options.regions[2].slot, 0);
  EXPECT_EQ(options.regions[1].label, "material 1");
  EXPECT_EQ(options.regions[3].label, "material 1");
  EXPECT_EQ(options.regions[3].slot, 1);
  EXPECT_EQ(options.props.size(), 1u);  // planes are left out
  scene.gravity.reset();
  ApplySceneLook(scene, mesh, options);
  EXPECT_FALSE(options.camera.up.has_value());
}

}  // namespace
}  // namespace cleave
