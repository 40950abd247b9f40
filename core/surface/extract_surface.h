#ifndef CLEAVE_CORE_SURFACE_EXTRACT_SURFACE_H_
#define CLEAVE_CORE_SURFACE_EXTRACT_SURFACE_H_

#include <cstdint>
#include <span>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/faces.h"
#include "core/surface/surface_topology.h"

namespace cleave {

struct SurfaceOptions {
  // Moves the points inside faces and tets to the mean of the midpoints of their separated edges,
  // which makes cuts of one or two vertices flat. Without it they stay at the centroids, where each
  // node's share of a tet is exactly a quarter.
  bool smooth = true;
};

// The visible surface of a mesh with broken edges, with no new elements: each tet whose vertices
// its unbroken edges no longer join is split into corner cells (vertex, edge midpoints, face and
// tet points), and cells of different groups of vertices face each other across quads, one for each
// side. Whatever is not split keeps its plain boundary triangles, with a midpoint where a split
// neighbour has one. Points are copied where cracks run through and not at crack tips.
//
// Source: method note, section 8. The pinch edges that it names (four crack faces round a segment
// whose ends stay whole) are resolved by a point of its own on each side. Crack faces may still
// touch in a point, and where the mesh itself is joined only by a node or an edge, so is the
// surface.
//
// Preconditions: edge ids are in range and ascending; `faces` is the mesh's. Time and memory follow
// the boundary and the split tets, plus a few linear sweeps over flags.
SurfaceTopology ExtractSurface(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                               std::span<const int32_t> broken_edges,
                               const SurfaceOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_EXTRACT_SURFACE_H_
