#ifndef CLEAVE_CORE_MESH_COINCIDENT_NODES_H_
#define CLEAVE_CORE_MESH_COINCIDENT_NODES_H_

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// Nodes that lie on an earlier node.
struct CoincidentNodes {
  int64_t count = 0;
  int64_t first = -1;  // the lowest such node, or -1
};

// Counts nodes within 1e-9 of the bounding box's longest side of an earlier node that is not itself
// counted. Nodes with coordinates that are not finite are passed over. Time
// and memory grow linearly.
CoincidentNodes FindCoincidentNodes(const std::vector<Vec3>& positions);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_COINCIDENT_NODES_H_
