#ifndef CLEAVE_CORE_SOLVER_RAYLEIGH_DAMPING_H_
#define CLEAVE_CORE_SOLVER_RAYLEIGH_DAMPING_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/double4.h"
#include "core/model/model.h"
#include "core/model/nodal_vector.h"
#include "core/solver/block_sums.h"
#include "core/solver/stiffness_matrix.h"

namespace cleave {

// Rayleigh damping of a body in a backward Euler step from x_n to x: the forces
//
//   -C (x - x_n) / dt,   C = a M + b K_n,
//
// of the incremental potential (x - x_n)^T C (x - x_n) / (2 dt). M is the mass of the nodes, K_n
// the elastic stiffness at x_n without negative eigenvalues, so that C is constant in the step and
// no motion gains energy. Forces are those of the blocks of K_n as stored (EdgeBlocks), so b
// resists no translation and keeps momentum to the rounding of these floats. Of angular momentum it
// takes what K_n does: internal forces f turn with the body, K_n (w x r) = w x f, so that a spin w
// decays at the rate b w^2, besides what a step turns beyond first order. The potential is summed
// up along the way of a solve, which is exact for a quadratic one: from x_n it would be lost in the
// rounding of the blocks where a body flies fast. Source: method note, section 7. Not thread-safe;
// loops run on the caller's TBB arena and give the same bits for any number of threads.
class RayleighDamping {
 public:
  // `model.damping` must be set; `model` must outlive this object.
  explicit RayleighDamping(const Model& model);

  // Sets C at the displacements (m) that a step starts from, where the branches of energies are
  // chosen.
  void BeginStep(const NodalVector& displacements);

  // Where a solve starts: unknowns have `moved` (m) in `dt` (s). Of the next solves, the nodes of
  // `blocks` count.
  void SetMotion(const NodalVector& moved, double dt, NodeBlocks& blocks);
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

  // Adds C / dt, of the last SetMotion, to a matrix whose inertia is `inertia`, kg/s^2.
  void AddTo(StiffnessMatrix& matrix, const std::vector<double>& inertia);

  int64_t bytes() const;

 private:
  // Sets the forces of `moved` in `dt_`, N.
  void SetForces(const NodalVector& moved, NodeBlocks& blocks, NodalVector& forces) const;

  const Model& model_;
  std::vector<double> rates_;                  // a M, kg/s, an unknown each
  std::optional<StiffnessMatrix> resistance_;  // C, where b is above 0
  std::vector<double> diagonal_;               // kg/s^2, inertia and a M / dt
  double dt_ = 0;                              // s
  NodalVector forces_;                         // N, C (x - x_n) / dt
  NodalVector search_forces_;                  // N, C search / dt
  double potential_ = 0;                       // J
  double slope_ = 0;                           // J, of it along the search
  double half_curvature_ = 0;                  // J
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_RAYLEIGH_DAMPING_H_
