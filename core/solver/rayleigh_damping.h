#ifndef CLEAVE_CORE_SOLVER_RAYLEIGH_DAMPING_H_
#define CLEAVE_CORE_SOLVER_RAYLEIGH_DAMPING_H_

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/double4.h"
#include "core/model/model.h"
#include "core/model/nodal_vector.h"
#include "core/solver/block_sums.h"
#include "core/solver/rigid_steps.h"
#include "core/solver/stiffness_matrix.h"

namespace cleave {

// Rayleigh damping of a body in a backward Euler step from x_n to x: the forces
//
//   -(a M (x - x_n) + b K_n (x - y)) / dt
//
// of a quadratic potential. M is the mass of the nodes, K_n the elastic stiffness at x_n without
// negative eigenvalues, and y where each piece gets that goes on as a rigid one (RigidSteps). That
// is where we depart from the note, which has x_n for y: K_n takes a turn by an angle t for a
// stretch of t^2 / 2, and b would stop in a few steps what is stiff and spins. By convexity the
// forces take no less than the potential at x less that at x_n, so that they give energy back at
// most where something stops a spin within a step, and then no more than the latter.
//
// Forces of b are those of the blocks of K_n as stored (EdgeBlocks), so it resists no translation
// and keeps momentum to the rounding of these floats. The potential is summed up along the way of a
// solve, which is exact for a quadratic one: from its start it would be lost in the rounding of the
// blocks where a body flies fast. Source: method note, section 7. Not thread-safe; loops run on the
// caller's TBB arena and give the same bits for any number of threads.
class RayleighDamping {
 public:
  // `model.damping` must be set; `model` must outlive this object.
  explicit RayleighDamping(const Model& model);

  // Which edges are broken now, where that has changed.
  void SetBroken(std::span<const uint8_t> broken);
  // Sets K_n and y for a step of `dt` (s) from `start`, at which the branches of energies are
  // chosen.
  void BeginStep(const State& start, double dt);

  // Where a solve of that step starts: unknowns have `moved` (m), which is overwritten. Of the next
  // solves, the nodes of `blocks` count.
  void SetMotion(NodalVector& moved, NodeBlocks& blocks);
  // Where it searches (m).
  void SetSearch(const NodalVector& search, NodeBlocks& blocks);
  // It went `share` of the way.
  void Accept(double share, NodeBlocks& blocks);

  // At `share` of the way along the search: J, and N, what the motion is resisted with.
  double Potential(double share) const {
    return potential_ + share * (slope_ + share * half_curvature_);
  }
  Double4 Resistance(size_t unknown, double share) const {
    return forces_[unknown] + share * search_forces_[unknown];
  }

  // Adds (a M + b K_n) / dt to a matrix whose inertia is `inertia`, kg/s^2.
  void AddTo(StiffnessMatrix& matrix, const std::vector<double>& inertia);

  int64_t bytes() const;

 private:
  // Sets (a M + b K_n) / dt times a way (m), N.
  void SetForces(const NodalVector& way, NodeBlocks& blocks, NodalVector& forces) const;

  const Model& model_;
  std::vector<double> rates_;  // a M, kg/s, an unknown each
  // Where b is above 0: a M + b K_n, and what tells y.
  std::optional<StiffnessMatrix> resistance_;
  std::optional<RigidSteps> rigid_steps_;
  std::vector<double> diagonal_;  // kg/s^2, inertia and a M / dt
  double dt_ = 0;                 // s
  NodalVector forces_;            // N, what the motion is resisted with
  NodalVector search_forces_;     // N, (a M + b K_n) / dt times the search
  double potential_ = 0;          // J
  double slope_ = 0;              // J, of it along the search
  double half_curvature_ = 0;     // J
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_RAYLEIGH_DAMPING_H_
