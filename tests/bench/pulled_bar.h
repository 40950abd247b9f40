#ifndef CLEAVE_TESTS_BENCH_PULLED_BAR_H_
#define CLEAVE_TESTS_BENCH_PULLED_BAR_H_

#include "core/scene/scene.h"

namespace cleave {

// A bar from x = 0 to 0.3 m, 0.1 m thick, whose ends move apart by `travel` (m) each within a
// second and turn about x against each other by `turn` (rad) each; one step a frame.
Scene PulledBar(const Material& material, double travel, double turn, double frames_per_second);

}  // namespace cleave

#endif  // CLEAVE_TESTS_BENCH_PULLED_BAR_H_
