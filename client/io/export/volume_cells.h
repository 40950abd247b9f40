#ifndef CLEAVE_CLIENT_IO_EXPORT_VOLUME_CELLS_H_
#define CLEAVE_CLIENT_IO_EXPORT_VOLUME_CELLS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/damage/edge_mask.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/surface_topology.h"

namespace cleave {

// A mesh as cells: whole tets, and four corner cells (hexahedra) in place of each tet whose
// vertices are separated. The cells of one tet share the points of joined vertices, those of
// different tets only its nodes. The corner cells of a tet have its rest volume, a quarter each.
// Source: method note, section 8, without its smoothing and without copies shared between tets.
struct VolumeCells {
  // Only `points` and `tet_masks` are filled: what moving the points takes. The first points are
  // the mesh's nodes.
  SurfaceTopology topology;
  std::vector<int64_t> connectivity;  // point ids of all cells, end to end, in VTK's order
  std::vector<int64_t> offsets;       // a cell each
  std::vector<uint8_t> types;         // a cell each: VTK's numbers
  std::vector<int32_t> cell_tets;     // a cell each
  std::vector<int32_t> cell_nodes;   // a cell each: the vertex of a corner cell, a tet's first node
  std::vector<int32_t> point_nodes;  // a point each: a node on its side
};

// Precondition: a mask a tet.
VolumeCells BuildVolumeCells(const TetMesh& mesh, std::span<const EdgeMask> tet_masks);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_VOLUME_CELLS_H_
