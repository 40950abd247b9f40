#ifndef CLEAVE_CORE_SURFACE_FANS_H_
#define CLEAVE_CORE_SURFACE_FANS_H_

#include "core/surface/surface_topology.h"

namespace cleave {

// Gives each fan of triangles round a point a point of its own, so that sheets of a surface which
// only touch there, as crack faces may, and a mesh that is joined by a node alone, are parted: a
// closed surface all of whose edges lie between two triangles (shared_edges.h) is a 2-manifold
// then. New points follow the others, with the same record; the fan with the smallest triangle id
// keeps the point's id, and others get surface_id::OfFan of it in the order of their own smallest,
// so that ids follow from the surface alone. Time and memory follow the surface. Fans beyond
// surface_id::kMaxFan of one point stay joined.
void SeparateFans(SurfaceTopology& topology);

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_FANS_H_
