#include "tests/bench/core/step_cost.h"

#include <tbb/global_control.h>

#include <algorithm>

#include "core/base/status.h"
#include "core/simulation/simulation.h"

namespace cleave {

absl::StatusOr<std::vector<StepCost>> MeasureSteps(const TetMesh& mesh,
                                                   const std::vector<BenchCase>& cases, int frames,
                                                   int rounds) {
  std::vector<std::vector<FrameReport>> least(cases.size());
  const StopFlag stop;
  for (int round = 0; round < rounds; ++round) {
    for (size_t k = 0; k < cases.size(); ++k) {
      tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                static_cast<size_t>(cases[k].threads));
      Simulation::Options options;
      options.threads = cases[k].threads;
      CLEAVE_ASSIGN_OR_RETURN(const auto simulation,
                              Simulation::Create(cases[k].scene, mesh, options));
      for (size_t frame = 0; frame < static_cast<size_t>(frames); ++frame) {
        CLEAVE_ASSIGN_OR_RETURN(const FrameReport report, simulation->Advance(stop));
        if (least[k].size() == frame) least[k].push_back(report);
        if (report.total_seconds < least[k][frame].total_seconds) least[k][frame] = report;
      }
    }
  }
  std::vector<StepCost> costs;
  for (const std::vector<FrameReport>& reports : least) {
    StepCost& cost = costs.emplace_back();
    for (const FrameReport& report : reports) {
      cost.steps += report.steps;
      cost.newton_iterations += report.newton_iterations;
      cost.linear_iterations += report.linear_iterations;
      cost.broken_edges = report.broken_edges;
      cost.total += report.total_seconds;
      cost.assembly += report.assembly_seconds;
      cost.linear += report.linear_solve_seconds;
      cost.fracture += report.fracture_seconds;
    }
  }
  return costs;
}

}  // namespace cleave
