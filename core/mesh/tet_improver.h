#ifndef CLEAVE_CORE_MESH_TET_IMPROVER_H_
#define CLEAVE_CORE_MESH_TET_IMPROVER_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/placed_points.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Removes slivers from a tet mesh by local changes, each of which raises the smallest sine of a
// dihedral angle among the tets that it touches: a face becomes an edge (2-3 flip), an edge is
// removed and its ring of tets filled anew (3-2, 4-4, 5-6 flips and on), a node moves within its
// binding (after Freitag and Ollivier-Gooch 1997, Klincsek 1980 for rings). Deterministic.
class TetImprover {
 public:
  // Precondition: every tet has positive volume and no face has more than two.
  TetImprover(PlacedPoints points, const std::vector<std::array<int32_t, 4>>& tets);

  // Takes away tets with all nodes at `radius` from the z axis and their middle within `depth` of
  // the round side: the hull of points on a cylinder bridges those between.
  void PeelRoundSide(double radius, double depth);

  // Works on every tet with a sine below `wanted` until none gives way, at most `passes` times.
  // Returns the smallest sine.
  double Improve(double wanted, int passes);

  // The mesh without the nodes that are in no tet.
  TetMesh Take();

 private:
  struct Cell {
    std::array<int32_t, 4> nodes;
    std::array<int32_t, 4> neighbours;  // across the face opposite to nodes[i]; -1 on the surface
    bool alive = true;
  };
  // The tets round an edge (a, b): ring[i], ring[i + 1] are the other nodes of cells[i], and the
  // tet (a, b, ring[i], ring[i + 1]) has positive volume.
  struct Ring {
    int32_t a;
    int32_t b;
    bool closed;
    std::vector<int32_t> nodes;
    std::vector<int32_t> cells;
  };

  double QualityOf(const std::array<int32_t, 4>& nodes) const;
  double QualityOf(int32_t cell) const { return QualityOf(CellAt(cell).nodes); }
  double Distance(int32_t a, int32_t b) const;
  const Cell& CellAt(int32_t id) const { return cells_[static_cast<size_t>(id)]; }

  void CollectStar(int32_t node);
  bool CollectRing(int32_t cell, int32_t a, int32_t b);
  bool OnSurface(int32_t node);
  bool HasEdge(int32_t a, int32_t b);

  bool TurnFace(int32_t cell, size_t slot);
  bool RemoveEdge(int32_t cell, size_t a, size_t b);
  bool MoveNode(int32_t node);
  void Replace(const std::vector<int32_t>& old_cells,
               const std::vector<std::array<int32_t, 4>>& new_cells);
  void RemoveCell(int32_t cell);

  PlacedPoints points_;
  std::vector<Cell> cells_;
  std::vector<int32_t> cell_of_node_;  // one tet of each node, or -1
  std::vector<int32_t> free_;
  uint64_t draws_ = 0;
  // Scratch.
  std::vector<int32_t> star_;
  std::vector<uint32_t> seen_;
  uint32_t visit_ = 0;
  Ring ring_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_TET_IMPROVER_H_
