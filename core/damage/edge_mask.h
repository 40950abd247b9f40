#ifndef CLEAVE_CORE_DAMAGE_EDGE_MASK_H_
#define CLEAVE_CORE_DAMAGE_EDGE_MASK_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Which of a tet's six edges are broken: bit k stands for edge kTetEdges[k].
using EdgeMask = uint8_t;
inline constexpr int kEdgeMasks = 64;
inline constexpr EdgeMask kAllEdges = kEdgeMasks - 1;

// How the unbroken edges of a tet join its four vertices.
struct VertexGroups {
  std::array<int8_t, 4> group{};  // of each vertex: the smallest vertex joined to it
  int8_t count = 0;               // groups
};

// The groups for an edge mask.
constexpr VertexGroups GroupVertices(EdgeMask mask) {
  VertexGroups groups{{0, 1, 2, 3}, 4};
  for (int k = 0; k < 6; ++k) {
    if ((mask >> k & 1) != 0) continue;
    const int8_t a = groups.group[static_cast<size_t>(kTetEdges[static_cast<size_t>(k)][0])];
    const int8_t b = groups.group[static_cast<size_t>(kTetEdges[static_cast<size_t>(k)][1])];
    if (a == b) continue;
    --groups.count;
    for (int8_t& group : groups.group) {
      if (group == (a < b ? b : a)) group = a < b ? a : b;
    }
  }
  return groups;
}

// GroupVertices of every mask (method note, section 3, rule 1).
inline constexpr std::array<VertexGroups, kEdgeMasks> kVertexGroups = [] {
  std::array<VertexGroups, kEdgeMasks> table{};
  for (int mask = 0; mask < kEdgeMasks; ++mask)
    table[static_cast<size_t>(mask)] = GroupVertices(static_cast<EdgeMask>(mask));
  return table;
}();

// Whether the unbroken edges no longer join the four vertices: such a tet carries no force.
constexpr bool Separated(EdgeMask mask) { return kVertexGroups[mask].count > 1; }

// The mask of every tet. Precondition: edge ids are in range. Together with Separated() this is the
// live state of a mesh for anyone who knows only its broken edges: what the hinge rule kills is
// separated by the orphan rule, so only tets dead by a damage factor below kDeadFactor
// (fracture.h) look live here.
std::vector<EdgeMask> TetEdgeMasks(const Incidence& incidence,
                                   std::span<const int32_t> broken_edges);

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_EDGE_MASK_H_
