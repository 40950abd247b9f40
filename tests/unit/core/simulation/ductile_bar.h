#ifndef CLEAVE_TESTS_UNIT_CORE_SIMULATION_DUCTILE_BAR_H_
#define CLEAVE_TESTS_UNIT_CORE_SIMULATION_DUCTILE_BAR_H_

#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {

// A unit cube of E = 1 MPa and nu = 0.3 that is pulled along x, free to narrow, so slowly that it
// is always at rest: all of it has the same strain. Times (s) and elongations; steps of 2.5 ms.
inline TetMesh PulledBarMesh() { return KuhnBox({1, 1, 1}, {1, 1, 1}); }

inline Scene PulledBar(const std::vector<std::pair<double, double>>& elongations) {
  constexpr double kFar = 1e6;
  Scene scene = TightScene(1e6, 0.3, 1e-3, 0.0025);
  scene.quality.residual_tolerance = 1e-8;
  AddSymmetryPlanes(scene);
  AddBoxSet(scene, "x1", {1 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  Motion& pull = AddMotion(scene, "x1", {true, false, false});
  for (const auto& [time, elongation] : elongations)
    pull.keyframes.push_back({time, {elongation, 0, 0}, 0});
  return scene;
}

// A bar that is pulled and twisted far beyond yield: 576 tets, some chunks of work.
inline TetMesh TwistedBarMesh() { return KuhnBox({6, 4, 4}, {2, 1, 1}); }

inline Scene TwistedBar() {
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  scene.quality.residual_tolerance = 1e-7;
  scene.materials[0].plasticity = Plasticity{.yield_stress = 1e4, .hardening = 1e4};
  AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(scene, "right", {2 - 1e-9, -1, -1}, {3, 2, 2});
  AddMotion(scene, "left");
  Motion& pull = AddMotion(scene, "right");
  pull.rotation_axis = {1, 0, 0};
  pull.rotation_center = {0, 0.5, 0.5};
  pull.keyframes = {{0, {0, 0, 0}, 0}, {0.1, {0.4, 0, 0}, 0.4}};
  return scene;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_SIMULATION_DUCTILE_BAR_H_
