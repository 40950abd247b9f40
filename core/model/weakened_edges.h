#ifndef CLEAVE_CORE_MODEL_WEAKENED_EDGES_H_
#define CLEAVE_CORE_MODEL_WEAKENED_EDGES_H_

#include <span>

#include "core/mesh/incidence.h"
#include "core/mesh/reorder.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// Applies `scene.weakenings` to the thresholds (Pa) of the solver's edges: of all that hold for an
// edge, the last counts. `mesh` is in the client's order, which `order` leads from. A factor of 0
// makes 0 of any threshold, an infinite one infinity. Precondition: the scene passed validation.
void WeakenEdges(const Scene& scene, const TetMesh& mesh, const MeshOrder& order,
                 const Incidence& incidence, std::span<double> thresholds);

// Multiplies thresholds (Pa) by the factors of layers of impurities, an edge each or none at all,
// by the same rule.
void CountFactors(std::span<const double> factors, std::span<double> thresholds);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_WEAKENED_EDGES_H_
