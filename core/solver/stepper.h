#ifndef CLEAVE_CORE_SOLVER_STEPPER_H_
#define CLEAVE_CORE_SOLVER_STEPPER_H_

#include <vector>

#include "absl/status/status.h"
#include "core/base/stop_flag.h"
#include "core/model/model.h"
#include "core/solver/newton.h"
#include "core/solver/step_report.h"

namespace cleave {

// Moves a body through time by backward Euler. Not thread-safe; loops run on the caller's TBB arena
// and give the same bits for any number of threads.
class Stepper {
 public:
  // `model` must outlive the stepper.
  explicit Stepper(const Model& model);

  // Moves `state` from time `start` (s) to `end`. A step that does not converge is cut in two, up
  // to quality.max_step_halvings times. Adds to `report`. Errors: Aborted when the smallest part
  // does not converge, naming the worst node; Cancelled. After an error `state` is that of some
  // instant in between: the caller keeps a copy.
  absl::Status Step(double start, double end, const StopFlag& stop, State& state,
                    StepReport& report);

  // Of the last step that succeeded.
  const NewtonSolver& solver() const { return newton_; }
  int64_t bytes() const;

 private:
  absl::Status SolveStep(double start, double end, const StopFlag& stop, State& state,
                         StepReport& report);
  void AddWork(const State& state, StepReport& report) const;

  const Model& model_;
  NewtonSolver newton_;
  NodalVector displacements_;  // m, at the end of the step
};

// J.
double KineticEnergy(const Model& model, const State& state);

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_STEPPER_H_
