#ifndef CLEAVE_CORE_SOLVER_STEP_REPORT_H_
#define CLEAVE_CORE_SOLVER_STEP_REPORT_H_

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/solver/edge_break.h"

namespace cleave {

// What steps took and reached; sums over them unless a field says otherwise.
struct StepReport {
  int32_t steps = 0;  // the parts of halved steps count each
  int32_t step_halvings = 0;
  double shortest_step = 0;  // s, of all parts
  int32_t newton_iterations = 0;
  int32_t linear_iterations = 0;
  int32_t break_passes = 0;
  double residual = 0;         // worst relative force residual at which a solve stopped
  double external_work = 0;    // J, by gravity, prescribed motions and loads
  double fracture_energy = 0;  // J, elastic energy lost to breaking
  double plastic_work = 0;     // J, elastic energy lost to plastic flow
  // J, what backward Euler and the staging of fracture within steps took out.
  double integration_dissipation = 0;
  double contact_energy = 0;        // J, that node terms hold at the end of the last step
  double friction_dissipation = 0;  // J, that node terms took out for good
  // J, that Rayleigh damping took out; of a step that breaks something the mean of what its motion
  // before and after would lose.
  double damping_dissipation = 0;
  double assembly_seconds = 0;
  double linear_solve_seconds = 0;
  double fracture_seconds = 0;
  std::vector<EdgeBreak> edge_breaks;  // solver's ids; by step, pass and id
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_STEP_REPORT_H_
