#include "core/mesh/tet_complex.h"

#include <algorithm>
#include <utility>

#include "core/mesh/faces.h"

namespace cleave {
namespace {

std::array<int32_t, 3> Sorted(std::array<int32_t, 3> face) {
  std::sort(face.begin(), face.end());
  return face;
}

size_t SlotOf(const std::array<int32_t, 4>& nodes, int32_t node) {
  return static_cast<size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

}  // namespace

std::array<int32_t, 3> FaceOf(const std::array<int32_t, 4>& nodes, size_t slot) {
  const auto& face = kTetFaces[slot];
  return {nodes[static_cast<size_t>(face[0])], nodes[static_cast<size_t>(face[1])],
          nodes[static_cast<size_t>(face[2])]};
}

TetComplex::TetComplex(size_t node_count, const std::vector<std::array<int32_t, 4>>& tets)
    : cell_of_node_(node_count, kOutside), seen_(tets.size(), 0) {
  cells_.reserve(tets.size());
  for (const auto& nodes : tets) {
    for (const int32_t node : nodes)
      cell_of_node_[static_cast<size_t>(node)] = static_cast<int32_t>(cells_.size());
    cells_.push_back({nodes, {kOutside, kOutside, kOutside, kOutside}});
  }
  TetMesh mesh;
  mesh.rest_positions.resize(node_count);
  mesh.tets = tets;
  ForEachFace(
      mesh, [](int64_t) { return true; },
      [&](std::span<const FaceUse> uses) {
        if (uses.size() != 2) return;
        for (size_t i = 0; i < 2; ++i) {
          cells_[static_cast<size_t>(uses[i].tet)].neighbours[static_cast<size_t>(uses[i].local)] =
              uses[1 - i].tet;
        }
      });
}

const std::vector<int32_t>& TetComplex::StarOf(int32_t node) {
  star_.clear();
  const int32_t first = cell_of_node_[static_cast<size_t>(node)];
  if (first == kOutside) return star_;
  ++visit_;
  star_.push_back(first);
  seen_[static_cast<size_t>(first)] = visit_;
  for (size_t next = 0; next < star_.size(); ++next) {
    const Cell& cell = CellAt(star_[next]);
    for (size_t slot = 0; slot < 4; ++slot) {
      const int32_t other = cell.neighbours[slot];
      if (cell.nodes[slot] == node || other == kOutside) continue;
      if (std::exchange(seen_[static_cast<size_t>(other)], visit_) != visit_)
        star_.push_back(other);
    }
  }
  return star_;
}

bool TetComplex::CollectRing(int32_t cell, int32_t a, int32_t b, Ring& ring) const {
  // In the given tet, find the order of the other two that makes positive volume.
  const std::array<int32_t, 4>& nodes = CellAt(cell).nodes;
  std::array<int32_t, 2> others;
  size_t count = 0;
  for (const int32_t node : nodes) {
    if (node != a && node != b) others[count++] = node;
  }
  // (a, b, c, d) is positive when it is an even permutation of the tet's own order.
  const std::array<size_t, 4> order = {SlotOf(nodes, a), SlotOf(nodes, b), SlotOf(nodes, others[0]),
                                       SlotOf(nodes, others[1])};
  bool even = true;
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = i + 1; j < 4; ++j) even = even == (order[i] < order[j]);
  if (!even) std::swap(others[0], others[1]);
  ring.a = a;
  ring.b = b;
  ring.closed = false;
  ring.nodes.assign({others[0], others[1]});
  ring.cells.assign(1, cell);
  // Onward across the face that keeps the last ring node.
  int32_t at = cell;
  int32_t leave = others[0];
  while (true) {
    const int32_t across = CellAt(at).neighbours[SlotOf(CellAt(at).nodes, leave)];
    if (across == kOutside) break;
    if (across == cell) {
      ring.closed = true;
      ring.nodes.pop_back();  // it was the first again
      return ring.nodes.size() <= kMostRingNodes;
    }
    if (ring.cells.size() >= kMostRingNodes) return false;
    const int32_t kept = ring.nodes.back();
    int32_t met = kOutside;
    for (const int32_t node : CellAt(across).nodes) {
      if (node != a && node != b && node != kept) met = node;
    }
    ring.cells.push_back(across);
    ring.nodes.push_back(met);
    leave = kept;
    at = across;
  }
  // The edge is on the surface: the rest lies the other way.
  at = cell;
  leave = others[1];
  while (true) {
    const int32_t across = CellAt(at).neighbours[SlotOf(CellAt(at).nodes, leave)];
    if (across == kOutside) return true;
    if (ring.cells.size() >= kMostRingNodes) return false;
    const int32_t kept = ring.nodes.front();
    int32_t met = kOutside;
    for (const int32_t node : CellAt(across).nodes) {
      if (node != a && node != b && node != kept) met = node;
    }
    ring.cells.insert(ring.cells.begin(), across);
    ring.nodes.insert(ring.nodes.begin(), met);
    leave = kept;
    at = across;
  }
}

bool TetComplex::OnSurface(int32_t node) {
  for (const int32_t id : StarOf(node)) {
    for (size_t slot = 0; slot < 4; ++slot) {
      if (CellAt(id).nodes[slot] != node && CellAt(id).neighbours[slot] == kOutside) return true;
    }
  }
  return false;
}

bool TetComplex::HasEdge(int32_t a, int32_t b) {
  const std::vector<int32_t>& star = StarOf(a);
  return std::any_of(star.begin(), star.end(),
                     [&](int32_t id) { return SlotOf(CellAt(id).nodes, b) < 4; });
}

void TetComplex::Replace(const std::vector<int32_t>& old_cells,
                         const std::vector<std::array<int32_t, 4>>& new_cells) {
  struct Face {
    std::array<int32_t, 3> key;
    int32_t cell;
    size_t slot;
  };
  std::vector<Face> open;  // faces that wait for their other side
  for (const int32_t old : old_cells) {
    for (size_t slot = 0; slot < 4; ++slot) {
      const int32_t other = CellAt(old).neighbours[slot];
      if (other == kOutside ||
          std::find(old_cells.begin(), old_cells.end(), other) != old_cells.end())
        continue;
      const Cell& cell = CellAt(other);
      size_t back = 0;
      while (cell.neighbours[back] != old) ++back;
      open.push_back({Sorted(FaceOf(cell.nodes, back)), other, back});
    }
  }
  for (const int32_t old : old_cells) {
    cells_[static_cast<size_t>(old)].alive = false;
    free_.push_back(old);
  }
  for (const Face& face : open)
    cells_[static_cast<size_t>(face.cell)].neighbours[face.slot] = kOutside;
  for (const auto& nodes : new_cells) {
    if (free_.empty()) {
      free_.push_back(static_cast<int32_t>(cells_.size()));
      cells_.emplace_back();
      seen_.push_back(0);
    }
    const int32_t id = free_.back();
    free_.pop_back();
    Cell& cell = cells_[static_cast<size_t>(id)];
    cell = {nodes, {kOutside, kOutside, kOutside, kOutside}};
    for (size_t slot = 0; slot < 4; ++slot) {
      cell_of_node_[static_cast<size_t>(nodes[slot])] = id;
      const std::array<int32_t, 3> key = Sorted(FaceOf(nodes, slot));
      const auto match =
          std::find_if(open.begin(), open.end(), [&](const Face& face) { return face.key == key; });
      if (match == open.end()) {
        open.push_back({key, id, slot});
        continue;
      }
      cell.neighbours[slot] = match->cell;
      cells_[static_cast<size_t>(match->cell)].neighbours[match->slot] = id;
      open.erase(match);
    }
  }
}

void TetComplex::Remove(int32_t id) {
  Cell& cell = cells_[static_cast<size_t>(id)];
  cell.alive = false;
  for (const int32_t other : cell.neighbours) {
    if (other == kOutside) continue;
    for (int32_t& back : cells_[static_cast<size_t>(other)].neighbours) {
      if (back == id) back = kOutside;
    }
  }
  for (size_t k = 0; k < 4; ++k) {
    int32_t& home = cell_of_node_[static_cast<size_t>(cell.nodes[k])];
    if (home != id) continue;
    home = kOutside;
    for (size_t slot = 0; slot < 4; ++slot) {
      if (slot != k && cell.neighbours[slot] != kOutside) home = cell.neighbours[slot];
    }
  }
  free_.push_back(id);
}

}  // namespace cleave
