#ifndef CLEAVE_CORE_MESH_TET_COMPLEX_H_
#define CLEAVE_CORE_MESH_TET_COMPLEX_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cleave {

// Tets that know their neighbours, and may be replaced a few at a time. Knows nothing of positions.
// Not thread-safe, reading included: walks mark what they have seen.
class TetComplex {
 public:
  static constexpr int32_t kOutside = -1;
  // Edges with more tets round them are left alone.
  static constexpr size_t kMostRingNodes = 8;

  struct Cell {
    std::array<int32_t, 4> nodes;
    std::array<int32_t, 4> neighbours;  // across the face opposite to nodes[i], or kOutside
    bool alive = true;
  };
  // The tets round an edge (a, b): ring[i], ring[i + 1] are the other nodes of cells[i], and the
  // tet (a, b, ring[i], ring[i + 1]) has positive volume. Closed when the edge is inside.
  struct Ring {
    int32_t a;
    int32_t b;
    bool closed;
    std::vector<int32_t> nodes;
    std::vector<int32_t> cells;
  };

  // Precondition: tets of positive volume, node ids below node_count, no face in over two tets.
  TetComplex(size_t node_count, const std::vector<std::array<int32_t, 4>>& tets);

  // Cells have ids in [0, cell_count()); those not alive are gaps.
  int32_t cell_count() const { return static_cast<int32_t>(cells_.size()); }
  const Cell& CellAt(int32_t id) const { return cells_[static_cast<size_t>(id)]; }

  // The cells that hold a node; the list is good until the next call of any other method.
  const std::vector<int32_t>& StarOf(int32_t node);
  // Fills `ring` with the cells round the edge (a, b) of `cell`; false when there are too many.
  bool CollectRing(int32_t cell, int32_t a, int32_t b, Ring& ring) const;
  bool OnSurface(int32_t node);
  bool HasEdge(int32_t a, int32_t b);

  // Puts new cells in the place of old ones. Both must fill the same space, up to faces between
  // surface triangles, which then become surface or go.
  void Replace(const std::vector<int32_t>& old_cells,
               const std::vector<std::array<int32_t, 4>>& new_cells);
  void Remove(int32_t cell);

 private:
  std::vector<Cell> cells_;
  std::vector<int32_t> cell_of_node_;  // one cell of each node, or kOutside
  std::vector<int32_t> free_;
  // Scratch of walks.
  std::vector<int32_t> star_;
  std::vector<uint32_t> seen_;
  uint32_t visit_ = 0;
};

// Nodes of the face opposite to nodes[slot], turning outward.
std::array<int32_t, 3> FaceOf(const std::array<int32_t, 4>& nodes, size_t slot);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_TET_COMPLEX_H_
