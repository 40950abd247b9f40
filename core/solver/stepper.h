#ifndef CLEAVE_CORE_SOLVER_STEPPER_H_
#define CLEAVE_CORE_SOLVER_STEPPER_H_

#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "core/base/bytes.h"
#include "core/base/stop_flag.h"
#include "core/model/model.h"
#include "core/solver/breaking.h"
#include "core/solver/newton.h"
#include "core/solver/releases.h"
#include "core/solver/resting.h"
#include "core/solver/step_report.h"

namespace cleave {

// Moves a body through time by backward Euler. Where it can break, a step alternates solving and
// breaking: each solve starts over from the beginning of the step with the damage so far, and the
// velocities follow when no edge fails any more. Source: method note, section 7. Not thread-safe;
// loops run on the caller's TBB arena and give the same bits for any number of threads.
class Stepper {
 public:
  // `model` must outlive the stepper.
  explicit Stepper(const Model& model);

  // Moves `state` from time `start` (s) to `end`, in more than one part where node terms need it.
  // A part that does not converge is cut in two, up
  // to quality.max_step_halvings times. Adds to `report`. Errors: Aborted when the smallest part
  // does not converge, naming the worst node; Cancelled. After an error `state` is that of some
  // instant in between: the caller keeps a copy.
  absl::Status Step(double start, double end, const StopFlag& stop, State& state,
                    StepReport& report);

  // What decides later steps besides the state of the nodes: damage, and what terms carry along.
  // Restore refuses (DataLoss) what cannot belong to this body; after an error the stepper may hold
  // a part of either, and only another Restore makes it whole.
  void Save(ByteWriter& out) const;
  absl::Status Restore(ByteReader& in);

  // Of the last step that succeeded.
  const NewtonSolver& solver() const { return newton_; }
  // J, of the last step that succeeded.
  double elastic_energy() const { return elastic_energy_; }
  // N, that each motion exerts on the body at the end of the last step that succeeded.
  std::vector<Vec3> MotionForces(const State& state) const;
  // Null where nothing sleeps.
  const Resting* resting() const { return resting_ ? &*resting_ : nullptr; }
  // Null where nothing breaks.
  Breaking* breaking() { return breaking_ ? &*breaking_ : nullptr; }
  const Breaking* breaking() const { return breaking_ ? &*breaking_ : nullptr; }
  int64_t bytes() const;

 private:
  // How many equal parts the node terms want a step to be taken in.
  int32_t PartCount(double start, double end, const State& state) const;
  // Brings what follows damage and releases up to date before a step at `start` (s).
  void Prepare(double start, State& state);
  // Wakes and lets sleep before a step to `end` (s), whose node terms have begun.
  void UpdateResting(double end, const State& state);
  // Lets fall asleep what has come to rest in a step; returns the kinetic energy that this takes,
  // J.
  double EndRest(double dt, double plastic_work, State& state);
  bool all_asleep() const { return resting_ && resting_->all_asleep(); }
  absl::Status SolveStep(double start, double end, const StopFlag& stop, State& state,
                         StepReport& report);
  // Alternates breaking and solving until no edge fails. Adds the elastic energy lost to
  // breaking, and what re-solves gave away, J, and the edges that broke, but for their time.
  absl::Status Break(double dt, const StopFlag& stop, const State& state, double& fracture_energy,
                     double& integration, std::vector<EdgeBreak>& breaks, StepReport& report);
  void AddBreaks(std::vector<EdgeBreak>& breaks) const;
  // Finds the plastic strain after a step that ends at `displacements_`.
  void Flow();
  // J, of moving from `state` to `displacements_` in `dt` (s): where that ends, and half the
  // squared change of velocity.
  struct KineticEnergies {
    double end = 0;
    double change = 0;
  };
  KineticEnergies MovingEnergies(double dt, const State& state) const;
  // J, over the step from `state` to `displacements_`.
  double MotionWork(const State& state) const;
  double GravityWork(const State& state) const;
  // J, over the same step: what node terms did and hold at its end.
  double NodeTermBalance(const State& state) const;

  const Model& model_;
  NewtonSolver newton_;
  std::optional<Breaking> breaking_;
  std::optional<Releases> releases_;  // where something may be released
  std::optional<Resting> resting_;    // where pieces may sleep
  int64_t pieces_told_ = -1;          // broken edges that sleep and damping know; -1: none
  std::vector<Influence> influences_;
  double left_out_energy_ = 0;      // J, elastic, of what sleeps
  std::vector<uint8_t> fixed_for_;  // State::released that the solver's fixed nodes are of
  int64_t damage_told_ = -1;        // count of the damage that node terms know; -1: none
  NodalVector displacements_;       // m, at the end of the step
  double elastic_energy_ = 0;       // J, of the state
};

// J.
double KineticEnergy(const Model& model, const State& state);

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_STEPPER_H_
