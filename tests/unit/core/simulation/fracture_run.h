#ifndef CLEAVE_TESTS_UNIT_CORE_SIMULATION_FRACTURE_RUN_H_
#define CLEAVE_TESTS_UNIT_CORE_SIMULATION_FRACTURE_RUN_H_

#include "core/scene/scene.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {

// A bar of 1728 tets, enough for several chunks of work, that starts to break within a few frames.
inline TetMesh BreakingMesh() { return KuhnBox({18, 4, 4}, {4.5, 1, 1}); }

inline Scene BreakingScene() {
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  scene.quality = Quality{};
  scene.quality.newton_iterations = 20;
  scene.materials[0].tensile_strength = 2e4;
  scene.gravity = Vec3{0, 0, -9.81};
  AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(scene, "right", {4.5 - 1e-9, -1, -1}, {5, 2, 2});
  AddMotion(scene, "left");
  Motion& pull = AddMotion(scene, "right");
  pull.rotation_axis = {1, 0, 0};
  pull.rotation_center = {0, 0.5, 0.5};
  pull.keyframes = {{0, {0, 0, 0}, 0}, {1, {1.5, 0, 0}, 0.5}};
  return scene;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_SIMULATION_FRACTURE_RUN_H_
