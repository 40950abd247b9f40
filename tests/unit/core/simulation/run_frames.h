#ifndef CLEAVE_TESTS_UNIT_CORE_SIMULATION_RUN_FRAMES_H_
#define CLEAVE_TESTS_UNIT_CORE_SIMULATION_RUN_FRAMES_H_

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"

namespace cleave {

// Goes on by so many frames; the last one's report.
inline FrameReport RunFrames(Simulation& simulation, int frames) {
  const StopFlag stop;
  FrameReport last;
  for (int frame = 0; frame < frames; ++frame) {
    auto report = simulation.Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) break;
    last = *report;
  }
  return last;
}

// What the budget of energy leaves open, J: 0 where it closes. `start` is the energy at rest.
inline double Budget(const FrameReport& report, double start) {
  return report.external_work + start - report.kinetic_energy - report.elastic_energy -
         report.contact_energy - report.fracture_energy - report.friction_dissipation -
         report.integration_dissipation;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_SIMULATION_RUN_FRAMES_H_
