#ifndef CLEAVE_CORE_MODEL_IMPURITIES_H_
#define CLEAVE_CORE_MODEL_IMPURITIES_H_

#include <span>

#include "core/mesh/incidence.h"
#include "core/mesh/reorder.h"
#include "core/model/model.h"
#include "core/scene/scene.h"

namespace cleave {

// The potency of every node and what is drawn for edges, for a scene whose impurities are not
// kOff. `potencies` are in the client's order (BakeImpurities); `incidence` in the solver's, which
// `order` leads to. Draws belong to the client's ids. Precondition: the scene passed validation
// with the mesh.
ImpurityPart BuildImpurities(const Scene& scene, std::span<const double> potencies,
                             const MeshOrder& order, const Incidence& incidence);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_IMPURITIES_H_
