#include "core/surface/faces.h"

#include <algorithm>

namespace cleave {

Faces BuildFaces(const TetMesh& mesh) {
  struct Use {
    std::array<int32_t, 3> nodes;  // ascending
    int32_t slot;                  // 4 * tet + face
    bool operator<(const Use& other) const {
      return nodes != other.nodes ? nodes < other.nodes : slot < other.slot;
    }
  };
  const auto tets = static_cast<size_t>(mesh.tet_count());
  std::vector<Use> uses(4 * tets);
  for (size_t tet = 0; tet < tets; ++tet) {
    for (size_t face = 0; face < 4; ++face) {
      Use& use = uses[4 * tet + face];
      for (size_t i = 0; i < 3; ++i)
        use.nodes[i] = mesh.tets[tet][static_cast<size_t>(kTetFaces[face][i])];
      std::sort(use.nodes.begin(), use.nodes.end());
      use.slot = static_cast<int32_t>(4 * tet + face);
    }
  }
  std::sort(uses.begin(), uses.end());

  Faces faces;
  faces.neighbors.assign(tets, {-1, -1, -1, -1});
  const auto neighbor = [&](int32_t slot) -> int32_t& {
    return faces.neighbors[static_cast<size_t>(slot / 4)][static_cast<size_t>(slot % 4)];
  };
  for (size_t i = 0; i + 1 < uses.size(); ++i) {
    if (uses[i].nodes != uses[i + 1].nodes) continue;
    neighbor(uses[i].slot) = uses[i + 1].slot;
    neighbor(uses[i + 1].slot) = uses[i].slot;
  }
  for (int32_t tet = 0; tet < static_cast<int32_t>(tets); ++tet) {
    for (int32_t face = 0; face < 4; ++face) {
      if (neighbor(4 * tet + face) < 0) faces.boundary.push_back({tet, face});
    }
  }
  return faces;
}

}  // namespace cleave
