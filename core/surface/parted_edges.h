#ifndef CLEAVE_CORE_SURFACE_PARTED_EDGES_H_
#define CLEAVE_CORE_SURFACE_PARTED_EDGES_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/damage/edge_mask.h"
#include "core/mesh/incidence.h"

namespace cleave {

// Whether a tet's unbroken edges do not join the ends of its edge kTetEdges[k], if by way of
// others.
constexpr bool PartsEdge(EdgeMask mask, size_t k) {
  const VertexGroups& groups = kVertexGroups[mask];
  return groups.group[static_cast<size_t>(kTetEdges[k][0])] !=
         groups.group[static_cast<size_t>(kTetEdges[k][1])];
}

// Breaks edges, ids in range, in the masks of the tets round them (a tet each). Fills `parted`,
// ascending, with the edges, broken or not, whose ends some tet has come to part: what a surface
// has to be made anew round.
void BreakInTets(const Incidence& incidence, std::span<const int32_t> edges,
                 std::vector<EdgeMask>& tet_masks, std::vector<int32_t>& parted);

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_PARTED_EDGES_H_
