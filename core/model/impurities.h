#ifndef CLEAVE_CORE_MODEL_IMPURITIES_H_
#define CLEAVE_CORE_MODEL_IMPURITIES_H_

#include "core/mesh/incidence.h"
#include "core/mesh/reorder.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/model.h"
#include "core/scene/scene.h"

namespace cleave {

// The potency of every node and what is drawn for edges, for a scene whose impurities are not
// kOff. `mesh` is in the client's order; `incidence` in the solver's, which `order` leads to. Noise
// and draws belong to the client's ids. Precondition: the scene passed validation with the mesh.
ImpurityPart BuildImpurities(const Scene& scene, const TetMesh& mesh, const MeshOrder& order,
                             const Incidence& incidence);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_IMPURITIES_H_
