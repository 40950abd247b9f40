#ifndef CLEAVE_TESTS_UNIT_CORE_SIMULATION_RUN_FRAMES_H_
#define CLEAVE_TESTS_UNIT_CORE_SIMULATION_RUN_FRAMES_H_

#include <gtest/gtest.h>

#include <memory>

#include "core/simulation/simulation.h"

namespace cleave {

inline std::unique_ptr<Simulation> MustCreate(const Scene& scene, const TetMesh& mesh,
                                              int threads = 1) {
  Simulation::Options options;
  options.threads = threads;
  return *Simulation::Create(scene, mesh, options);
}

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

inline FrameReport MustAdvance(Simulation& simulation) { return RunFrames(simulation, 1); }

// What the budget of energy leaves open, J: 0 where it closes. `start` is the energy at rest.
inline double Budget(const FrameReport& report, double start) {
  return report.external_work + start - report.kinetic_energy - report.elastic_energy -
         report.contact_energy - report.fracture_energy - report.friction_dissipation -
         report.damping_dissipation - report.integration_dissipation;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_SIMULATION_RUN_FRAMES_H_
