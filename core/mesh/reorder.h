#ifndef CLEAVE_CORE_MESH_REORDER_H_
#define CLEAVE_CORE_MESH_REORDER_H_

#include <cstdint>
#include <vector>

#include "core/mesh/tet_mesh.h"

namespace cleave {

// A renumbering of nodes and tets, both ways.
struct MeshOrder {
  std::vector<int32_t> old_node;  // by new id
  std::vector<int32_t> new_node;  // by old id
  std::vector<int32_t> old_tet;   // by new id
  std::vector<int32_t> new_tet;   // by old id
};

// The order along a Morton curve through the bounding box, nodes by position and tets by centroid:
// what is near in space is near in memory. Equal positions keep the order of their ids.
// Precondition: the mesh passed CheckAndOrientMesh.
MeshOrder LocalityOrder(const TetMesh& mesh);

// The mesh renumbered. The order of nodes within a tet stays, and with it the numbering of its
// local edges and faces. Edge ids change, as they follow from node ids.
TetMesh Reordered(const TetMesh& mesh, const MeshOrder& order);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_REORDER_H_
