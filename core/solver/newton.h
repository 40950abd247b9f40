#ifndef CLEAVE_CORE_SOLVER_NEWTON_H_
#define CLEAVE_CORE_SOLVER_NEWTON_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/stop_flag.h"
#include "core/model/model.h"
#include "core/solver/block_sums.h"
#include "core/solver/constraints.h"
#include "core/solver/pcg.h"
#include "core/solver/rayleigh_damping.h"
#include "core/solver/step_report.h"
#include "core/solver/stiffness_matrix.h"

namespace cleave {

// Solves one backward Euler step: finds the displacements x that minimise the incremental potential
//
//   E(x) = |x - x_n - dt v_n|^2_M / (2 dt^2) + Psi(x) - M g . (x - x_n) + N(x) + R(x)
//
// N being the energy of the node terms and R that of Rayleigh damping, where there is any, over the
// coordinates that are not given, by Newton's method with positive semidefinite element stiffness
// and Armijo backtracking. Where the projection itself slows convergence down, or what stands in
// for friction that slips, the exact stiffness is tried, for as long as the linear solve finds it
// positive. Where there are fibres, which soften across their length when pressed, later solves of
// that time step begin with it. A linear solve goes no further than the step needs. Source: method
// note, section 7. Not thread-safe; loops run on the caller's TBB arena and give the same bits for
// any number of threads.
class NewtonSolver {
 public:
  // `model` must outlive the solver.
  explicit NewtonSolver(const Model& model);

  // Which coordinates are given from now on: ascending nodes, each once. At first, those of a state
  // in which nothing is released.
  void SetFixedNodes(std::vector<FixedNode> fixed_nodes);
  // Which unknowns there is anything to do for from now on (block_sums.h); at first, all. Every
  // coordinate of the others is given.
  void SetRuns(std::span<const std::array<int64_t, 2>> runs);

  // Which edges are broken now, where that has changed.
  void SetBroken(std::span<const uint8_t> broken);
  // To be called before the first Solve of a time step of `dt` (s) from `start`, at the
  // displacements (m) that it starts from: takes the stiffness that damps at `start`, and chooses
  // the branches of energies that jump. Solves leave them for lower ones only.
  void BeginStep(const State& start, double dt, const NodalVector& displacements,
                 StepReport& report);

  // Starts from `displacements` (m), whose given coordinates stay as they are, and leaves the
  // solution there. Stops when the free force residual is at most quality.residual_tolerance of the
  // summed norms of inertial, elastic and external forces and the last step moved no coordinate by
  // more than quality.step_tolerance of the mean edge; or when rounding hides any further decrease.
  // Errors: Aborted when quality.newton_iterations do not do, naming the client's id of the node
  // with the largest residual; Cancelled. After an error `displacements` hold no meaning.
  absl::Status Solve(const State& start, double dt, const StopFlag& stop,
                     NodalVector& displacements, StepReport& report);

  // Of the last Solve that succeeded, at its solution. Forces (N) are what each node needs from
  // outside, besides gravity, to move as it does: 0 up to the residual at free coordinates.
  const NodalVector& outer_forces() const { return gradient_; }
  // N, of the node terms, there; empty where the model has none.
  const NodalVector& node_forces() const { return node_forces_; }
  // J, of the node terms, there; 0 where the model has none.
  double node_energy() const { return node_energy_; }
  double elastic_energy() const { return elastic_energy_; }
  // J, by which that Solve lowered the incremental potential.
  double decrease() const { return initial_energy_ - energy_; }
  // J, work of the elastic forces at the solution along the way from the start of the step.
  double ElasticWork(const State& start, double dt, const NodalVector& displacements);
  // J, that Rayleigh damping takes out along the same way; 0 where there is none.
  double DampingLoss(const State& start, const NodalVector& displacements);
  // J, what the incremental potential has of it there.
  double damping_potential() const { return damping_ ? damping_->Potential(0) : 0; }
  // J, where that Solve started.
  double initial_elastic_energy() const { return initial_elastic_energy_; }

  const std::vector<FixedNode>& fixed_nodes() const { return fixed_nodes_; }
  int64_t bytes() const;

 private:
  // Runs body(begin, end) over all unknowns, those without a run too.
  template <typename Body>
  void ForAll(const Body& body) const {
    ParallelFor(static_cast<int64_t>(gradient_.size()), 4096, body);
  }
  // Sets the energies, gradient, residual and their norms at `displacements`, which lie `share` of
  // the way along the search.
  void Evaluate(const State& start, double dt, const NodalVector& displacements, double share);
  // Adds the node terms to what Evaluate set.
  void EvaluateNodeTerms(const NodalVector& displacements);
  // Adds Rayleigh damping to it.
  void EvaluateDamping(double share);
  // Sets the matrix, its preconditioner and what rounding may hide, at `displacements`.
  void Assemble(const NodalVector& displacements, Curvature curvature, StepReport& report);
  // Sets `search_` by a linear solve; returns whether it leads downhill.
  absl::StatusOr<bool> FindSearchDirection(const StopFlag& stop, StepReport& report);
  // Of all terms; true where any changed.
  bool ChooseBranches(const NodalVector& displacements, BranchChoice choice);
  absl::Status NotConverged(double relative_residual) const;

  const Model& model_;
  std::vector<FixedNode> fixed_nodes_;
  Double4 gravity_;           // m/s^2
  double gravity_force_ = 0;  // N, norm of all gravity forces
  NodeBlocks blocks_;
  StiffnessMatrix matrix_;
  PcgSolver pcg_;
  std::optional<RayleighDamping> damping_;
  const double element_rounding_;  // of elastic energies, in roundings of double
  std::vector<double> inertia_;    // kg/s^2, mass / dt^2
  NodalVector gradient_;           // N, dE/dx
  NodalVector residual_;           // N, -dE/dx, 0 at given coordinates
  NodalVector search_;             // m
  NodalVector trial_;              // m
  NodalVector node_forces_;        // N, of the node terms; empty where there is none

  // Whether the next solve begins with exact stiffness: where it helped earlier in the time step.
  bool exact_pays_ = false;

  double slope_ = 0;             // J, dE along the search direction
  double energy_ = 0;            // J
  double initial_energy_ = 0;    // J, where the Solve started
  double energy_magnitude_ = 0;  // J, sum of the sizes of its terms, weighted by their rounding
  double elastic_energy_ = 0;    // J
  double initial_elastic_energy_ = 0;
  double node_energy_ = 0;
  double residual_norm_ = 0;     // N
  double rounding_energy_ = 0;   // J, what rounding may hide of the elastic energy
  double rounding_force_ = 0;    // N, and of the forces
  double rounding_inertia_ = 0;  // N, of those the share of inertia: large where steps are tiny
  double force_scale_ = 0;       // N, what the residual is held against
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_NEWTON_H_
