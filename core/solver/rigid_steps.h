#ifndef CLEAVE_CORE_SOLVER_RIGID_STEPS_H_
#define CLEAVE_CORE_SOLVER_RIGID_STEPS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/double4.h"
#include "core/model/model.h"
#include "core/model/nodal_vector.h"

namespace cleave {

// How far each piece of a body would go in a step if it were rigid and nothing acted on it: with
// its momentum, and about its centre of mass with the angular velocity that its angular momentum
// gives it. Pieces are what connects through unbroken edges. Not thread-safe.
class RigidSteps {
 public:
  // `model` must outlive this object. At first, no edge is broken.
  explicit RigidSteps(const Model& model);

  // Which edges are broken now, where that has changed.
  void SetBroken(std::span<const uint8_t> broken);
  // Sets the ways of a step of `dt` (s) from `start`.
  void BeginStep(const State& start, double dt);

  // m, an unknown each; 0 for colliders and for nodes of no tet.
  const NodalVector& ways() const { return ways_; }

  int64_t bytes() const;

 private:
  struct Piece {
    double mass = 0;              // kg
    Double4 center = Splat(0);    // m
    Double4 velocity = Splat(0);  // m/s
    Double4 spin = Splat(0);      // kg m^2/s, about the centre
    // By columns, the second moment of mass about the centre, kg m^2; then how the step turns it,
    // less the identity.
    Double4 columns[3] = {Splat(0), Splat(0), Splat(0)};
  };

  const Model& model_;
  std::vector<int32_t> labels_;  // a piece each node, -1 for one of no tet
  std::vector<Piece> pieces_;
  NodalVector ways_;  // m
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_RIGID_STEPS_H_
