#include "client/io/export/volume_cells.h"

#include <array>
#include <cstddef>

#include "client/io/export/vtu.h"

namespace cleave {
namespace {

// The points of one separated tet, made when they are first asked for. `subset` and `owners` are
// sets of its vertices: bit k is vertex k.
class TetPoints {
 public:
  TetPoints(const TetMesh& mesh, size_t tet, VolumeCells& cells)
      : mesh_(mesh), nodes_(mesh.tets[tet]), cells_(cells) {
    for (auto& row : ids_) row.fill(-1);
  }

  int64_t Id(unsigned subset, unsigned owners) {
    int64_t& id = ids_[subset][owners];
    if (id >= 0) return id;
    SurfacePoint point;
    for (unsigned k = 0; k < 4; ++k) {
      if ((subset >> k & 1) == 0) continue;
      if ((owners >> k & 1) != 0) point.owners |= static_cast<uint8_t>(1u << point.node_count);
      point.nodes[point.node_count++] = nodes_[k];
    }
    int32_t side = -1;
    for (size_t k = 0; k < point.node_count; ++k) {
      point.weights[k] = 1.0 / point.node_count;
      const Vec3& node = mesh_.rest_positions[static_cast<size_t>(point.nodes[k])];
      for (size_t axis = 0; axis < 3; ++axis) point.rest[axis] += point.weights[k] * node[axis];
      if (side < 0 && (point.owners >> k & 1) != 0) side = point.nodes[k];
    }
    id = static_cast<int64_t>(cells_.topology.points.size());
    cells_.topology.points.push_back(point);
    cells_.point_nodes.push_back(side);
    return id;
  }

 private:
  const TetMesh& mesh_;
  const std::array<int32_t, 4>& nodes_;
  VolumeCells& cells_;
  std::array<std::array<int64_t, 16>, 16> ids_;
};

void AddCell(uint8_t type, size_t tet, int32_t node, VolumeCells& cells) {
  cells.types.push_back(type);
  cells.offsets.push_back(static_cast<int64_t>(cells.connectivity.size()));
  cells.cell_tets.push_back(static_cast<int32_t>(tet));
  cells.cell_nodes.push_back(node);
}

void AddCornerCells(const TetMesh& mesh, size_t tet, VolumeCells& cells) {
  const VertexGroups& groups = kVertexGroups[cells.topology.tet_masks[tet]];
  TetPoints points(mesh, tet, cells);
  for (size_t v = 0; v < 4; ++v) {
    unsigned group = 0;
    for (unsigned k = 0; k < 4; ++k) {
      if (groups.group[k] == groups.group[v]) group |= 1u << k;
    }
    const unsigned corner = 1u << v;
    const unsigned a = 1u << kTetFaces[v][0];
    const unsigned b = 1u << kTetFaces[v][1];
    const unsigned c = 1u << kTetFaces[v][2];
    // A hexahedron's lower square, then its upper one; here the vertex, three midpoints round it,
    // three face points and the tet's point.
    cells.connectivity.push_back(mesh.tets[tet][v]);
    for (const unsigned subset : {corner | a, corner | a | b, corner | b, corner | c,
                                  corner | a | c, 15u, corner | b | c}) {
      cells.connectivity.push_back(points.Id(subset, subset & group));
    }
    AddCell(kVtuHexahedron, tet, mesh.tets[tet][v], cells);
  }
}

}  // namespace

VolumeCells BuildVolumeCells(const TetMesh& mesh, std::span<const EdgeMask> tet_masks) {
  VolumeCells cells;
  cells.topology.tet_masks.assign(tet_masks.begin(), tet_masks.end());
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    SurfacePoint point;
    point.rest = mesh.rest_positions[node];
    point.nodes[0] = static_cast<int32_t>(node);
    point.weights[0] = 1;
    point.node_count = 1;
    point.owners = 1;
    cells.topology.points.push_back(point);
    cells.point_nodes.push_back(static_cast<int32_t>(node));
  }
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    if (Separated(tet_masks[tet])) {
      AddCornerCells(mesh, tet, cells);
      continue;
    }
    for (const int32_t node : mesh.tets[tet]) cells.connectivity.push_back(node);
    AddCell(kVtuTetrahedron, tet, mesh.tets[tet][0], cells);
  }
  return cells;
}

}  // namespace cleave
