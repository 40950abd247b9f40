#ifndef CLEAVE_CORE_SOLVER_CONSTRAINTS_H_
#define CLEAVE_CORE_SOLVER_CONSTRAINTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/model/model.h"
#include "core/model/nodal_vector.h"

namespace cleave {

// A node of which some coordinates are not for the solver to find.
struct FixedNode {
  int32_t node;
  Int64x4 axes;  // all ones along given axes, 0 along free ones and in the last lane
};

// In what follows `released` is State::released; motions that it lets go prescribe nothing.

// Which coordinates of `model` are given: those of prescribed motions, and all of the nodes without
// mass, which rest. Ascending nodes, each once.
std::vector<FixedNode> FindFixedNodes(const Model& model, const std::vector<uint8_t>& released);

// Writes the displacements (m) that the motions prescribe at `time` (s) into their coordinates.
void ApplyMotions(const Model& model, const std::vector<uint8_t>& released, double time,
                  NodalVector& displacements);

// Adds an influence from outside (node_term.h) for every node that a motion takes elsewhere by
// `time` (s).
void AddMotionInfluences(const Model& model, const std::vector<uint8_t>& released, double time,
                         const NodalVector& displacements, std::vector<Influence>& influences);

// Adds up, for each motion, the force on the body over its prescribed coordinates, 0 where it was
// let go. `forces` (N) are what each node needs from outside to move as it does.
std::vector<Vec3> SumMotionForces(const Model& model, const std::vector<uint8_t>& released,
                                  const NodalVector& forces);

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_CONSTRAINTS_H_
