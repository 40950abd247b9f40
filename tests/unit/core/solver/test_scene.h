#ifndef CLEAVE_TESTS_UNIT_CORE_SOLVER_TEST_SCENE_H_
#define CLEAVE_TESTS_UNIT_CORE_SOLVER_TEST_SCENE_H_

#include <array>
#include <string>

#include "core/scene/scene.h"

namespace cleave {

// One material, a step a frame, solved as tightly as doubles allow.
inline Scene TightScene(double youngs_modulus, double poisson_ratio, double density, double dt) {
  Scene scene;
  Material material;
  material.youngs_modulus = youngs_modulus;
  material.poisson_ratio = poisson_ratio;
  material.density = density;
  scene.materials.push_back(material);
  scene.timing.frames_per_second = 1 / dt;
  scene.timing.steps_per_frame = 1;
  scene.quality.newton_iterations = 60;
  scene.quality.residual_tolerance = 1e-12;
  scene.quality.step_tolerance = 1e-10;
  scene.quality.linear_tolerance = 1e-8;
  return scene;
}

inline void AddBoxSet(Scene& scene, const std::string& name, Vec3 min, Vec3 max) {
  NodeSet set;
  set.name = name;
  set.select.push_back(BoxSelector{min, max});
  scene.node_sets.push_back(set);
}

// Prescribes all or some axes of a set; without keyframes it is pinned.
inline Motion& AddMotion(Scene& scene, const std::string& set,
                         std::array<bool, 3> axes = {true, true, true}) {
  Motion motion;
  motion.node_set = set;
  motion.axes = axes;
  scene.motions.push_back(motion);
  return scene.motions.back();
}

// A body in the corner of x, y, z >= 0 slides along its sides there, as an eighth of a larger one.
inline void AddSymmetryPlanes(Scene& scene) {
  constexpr double kFar = 1e6;
  AddBoxSet(scene, "x0", {-kFar, -kFar, -kFar}, {1e-9, kFar, kFar});
  AddBoxSet(scene, "y0", {-kFar, -kFar, -kFar}, {kFar, 1e-9, kFar});
  AddBoxSet(scene, "z0", {-kFar, -kFar, -kFar}, {kFar, kFar, 1e-9});
  AddMotion(scene, "x0", {true, false, false});
  AddMotion(scene, "y0", {false, true, false});
  AddMotion(scene, "z0", {false, false, true});
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_SOLVER_TEST_SCENE_H_
