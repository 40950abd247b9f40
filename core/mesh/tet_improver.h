#ifndef CLEAVE_CORE_MESH_TET_IMPROVER_H_
#define CLEAVE_CORE_MESH_TET_IMPROVER_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/placed_points.h"
#include "core/mesh/tet_complex.h"
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
  double QualityOf(const std::array<int32_t, 4>& nodes) const;
  double QualityOf(int32_t cell) const { return QualityOf(CellAt(cell).nodes); }
  double Distance(int32_t a, int32_t b) const;
  const TetComplex::Cell& CellAt(int32_t id) const { return complex_.CellAt(id); }

  bool TurnFace(int32_t cell, size_t slot);
  bool RemoveEdge(int32_t cell, size_t a, size_t b);
  bool MoveNode(int32_t node);

  PlacedPoints points_;
  TetComplex complex_;
  TetComplex::Ring ring_;  // scratch
  uint64_t draws_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_TET_IMPROVER_H_
