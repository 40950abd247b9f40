#include "tests/bench/pulled_bar.h"

namespace cleave {

Scene PulledBar(const Material& material, double travel, double turn, double frames_per_second) {
  Scene scene;
  scene.materials.push_back(material);
  for (const bool left : {true, false}) {
    NodeSet set;
    set.name = left ? "left" : "right";
    set.select.push_back(left ? BoxSelector{{-1, -1, -1}, {1e-6, 1, 1}}
                              : BoxSelector{{0.3 - 1e-6, -1, -1}, {1, 1, 1}});
    scene.node_sets.push_back(set);
    const double sign = left ? -1 : 1;
    Motion motion;
    motion.node_set = set.name;
    motion.rotation_center = {0, 0.05, 0.05};
    motion.rotation_axis = {1, 0, 0};
    motion.keyframes = {{0, {0, 0, 0}, 0}, {1, {sign * travel, 0, 0}, sign * turn}};
    scene.motions.push_back(motion);
  }
  scene.timing.frames_per_second = frames_per_second;
  scene.timing.steps_per_frame = 1;
  return scene;
}

}  // namespace cleave
