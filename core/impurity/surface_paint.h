#ifndef CLEAVE_CORE_IMPURITY_SURFACE_PAINT_H_
#define CLEAVE_CORE_IMPURITY_SURFACE_PAINT_H_

#include <vector>

#include "core/mesh/tet_mesh.h"
#include "core/scene/impurities.h"

namespace cleave {

// The share of every node: that of the closest point of the painted surface, between its vertices
// linear or that of its texture there, times the falloff of how far it is beyond `depth` of it.
// `layer` is the one that the paint is of. Preconditions: CheckImpurities and
// CheckImpurityLayersOfMesh find no error.
std::vector<double> PaintShares(const SurfacePaint& paint, const ImpurityLayer& layer,
                                const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_IMPURITY_SURFACE_PAINT_H_
