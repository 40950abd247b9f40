#ifndef CLEAVE_CORE_SURFACE_SHARED_EDGES_H_
#define CLEAVE_CORE_SURFACE_SHARED_EDGES_H_

#include <cstdint>
#include <vector>

#include "core/mesh/render_mesh.h"
#include "core/surface/surface_topology.h"

namespace cleave {

// Parts sheets of a closed oriented surface that touch along an edge, as crack faces of a render
// mesh may, render meshes that are no manifold, and bodies joined by an edge alone: of the
// triangles round such an edge, those between which the surface is solid become neighbours; one two
// of them keep the edge, and every other two get a point of their own in its middle and are divided
// there. Each edge lies between two triangles then, and with SeparateFans after it the surface is a
// 2-manifold. Where edges have no counterpart, they stay.
//
// New points follow the others; ids of points and parts are surface_id::OfHalf and OfPart, and
// follow from the surface alone. `uvs` and `sources` are of the triangles, or empty. Time and
// memory follow the surface.
void SeparateSharedEdges(SurfaceTopology& topology, std::vector<CornerUvs>& uvs,
                         std::vector<int32_t>& sources);

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_SHARED_EDGES_H_
