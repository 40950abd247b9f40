#include "tests/bench/stream/simulated_frames.h"

#include <cstdio>

#include "core/mesh/procedural.h"
#include "core/simulation/simulation.h"
#include "tests/bench/pulled_bar.h"

namespace cleave {

SimulatedFrames SimulateBreakingBar() {
  constexpr int kFrames = 48;
  SimulatedFrames simulated;
  BoxMesh box;
  box.size = {0.3, 0.1, 0.1};
  box.resolution.layout = MeshLayout::kJitteredLattice;
  box.resolution.cell_size = 0.1 / 11;
  simulated.mesh = *BuildMesh(box);
  simulated.incidence = BuildIncidence(simulated.mesh);

  Material plastic;
  plastic.youngs_modulus = 1e8;
  plastic.poisson_ratio = 0.35;
  plastic.density = 1200;
  plastic.tensile_strength = 4e6;
  const Scene scene = PulledBar(plastic, 0.05, 0, 96);
  const auto simulation = Simulation::Create(scene, simulated.mesh, {});
  if (!simulation.ok()) {
    std::printf("%s\n", simulation.status().ToString().c_str());
    return simulated;
  }
  const StopFlag stop;
  for (int number = 0; number <= kFrames; ++number) {
    if (number > 0) {
      const auto report = (*simulation)->Advance(stop);
      if (!report.ok()) std::printf("%s\n", report.status().ToString().c_str());
    }
    simulated.frames.push_back({(*simulation)->frame(), (*simulation)->time(),
                                (*simulation)->fragments(), (*simulation)->positions(),
                                (*simulation)->broken_edges()});
  }
  return simulated;
}

}  // namespace cleave
