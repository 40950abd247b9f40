#ifndef CLEAVE_CORE_MODEL_LOAD_TERMS_H_
#define CLEAVE_CORE_MODEL_LOAD_TERMS_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/node_term.h"
#include "core/scene/scene.h"

namespace cleave {

// Times the load, at `time` (s): keyframes interpolated, held before the first and after the last;
// 1 without any.
double IntensityAt(const std::vector<LoadKeyframe>& keyframes, double time);

// The term of `load` on `nodes`, the solver's ids of its set without nodes of no tet. A step feels
// the load of its end. `release` is its place in State::released, -1 for a load that stays. `mesh`
// and `incidence`, the solver's, must outlive the term.
//
// Point forces and tractions do not depend on displacements. A pressure p has the energy p V, V
// being the volume between its faces and a fixed point: for faces that close a body its force and
// stiffness are exact, without net force or torque. Where the faces have a rim, that volume has
// sides between rim and point; what pushes on those is taken away again as it was at the start of
// the step, so that within it there is an energy. Source of the symmetric stiffness: Bonet and
// Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, on pressure over closed
// boundaries.
std::unique_ptr<NodeTerm> MakeLoadTerm(const Load& load, std::vector<int32_t> nodes,
                                       const TetMesh& mesh, const Incidence& incidence,
                                       int32_t release);

// The most bytes that a load's term takes on a mesh of so many nodes, keyframes aside, and what its
// stiffness adds to the solver's matrix: where its faces make a surface, with three edges and two
// faces a node.
int64_t LoadTermBytes(const Load& load, int64_t node_count);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_LOAD_TERMS_H_
