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

// Those triangles of a painted triangle surface that PaintShares looks at, ascending: the closest
// ones of all nodes that are within reach. Without the others every node has the same closest
// point. A surface that is finer than the mesh has few of them: what is sent can be as small as the
// mesh. Preconditions as above; the paint has vertices.
std::vector<int32_t> PaintingTriangles(const SurfacePaint& paint, const ImpurityLayer& layer,
                                       const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_IMPURITY_SURFACE_PAINT_H_
