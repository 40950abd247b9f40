#ifndef CLEAVE_CORE_MESH_FACES_H_
#define CLEAVE_CORE_MESH_FACES_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/tet_mesh.h"

namespace cleave {

// One tet's use of a face.
struct FaceUse {
  std::array<int32_t, 3> nodes;  // ascending
  int32_t tet;
  int8_t local;  // the face's place in kTetFaces
  bool even;     // whether the tet's outward order of the nodes is an even permutation of `nodes`
};

// Calls visit(std::span<const FaceUse>) for each face of the mesh with all its uses by ascending
// tet, faces by ascending nodes. Tets for which use_tet(tet) is false are passed over; the ids of
// all others must be in range and distinct.
template <typename UseTet, typename Visit>
void ForEachFace(const TetMesh& mesh, const UseTet& use_tet, const Visit& visit) {
  const auto nodes = static_cast<size_t>(mesh.node_count());
  // Filing by smallest node first leaves only short runs to sort.
  std::vector<int32_t> offsets(nodes + 1, 0);
  const auto for_each_use = [&](const auto& file) {
    for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
      if (!use_tet(tet)) continue;
      for (size_t k = 0; k < 4; ++k) {
        FaceUse use{{}, static_cast<int32_t>(tet), static_cast<int8_t>(k), true};
        for (size_t i = 0; i < 3; ++i)
          use.nodes[i] = mesh.tets[static_cast<size_t>(tet)][static_cast<size_t>(kTetFaces[k][i])];
        const auto order = [&](size_t i, size_t j) {
          if (use.nodes[i] < use.nodes[j]) return;
          std::swap(use.nodes[i], use.nodes[j]);
          use.even = !use.even;
        };
        order(0, 1);
        order(1, 2);
        order(0, 1);
        file(use);
      }
    }
  };
  for_each_use([&](const FaceUse& use) { ++offsets[static_cast<size_t>(use.nodes[0]) + 1]; });
  for (size_t node = 0; node < nodes; ++node) offsets[node + 1] += offsets[node];
  std::vector<FaceUse> uses(static_cast<size_t>(offsets[nodes]));
  std::vector<int32_t> next(offsets.begin(), offsets.end() - 1);
  for_each_use([&](const FaceUse& use) {
    uses[static_cast<size_t>(next[static_cast<size_t>(use.nodes[0])]++)] = use;
  });
  for (size_t node = 0; node < nodes; ++node) {
    const auto begin = uses.begin() + offsets[node];
    const auto end = uses.begin() + offsets[node + 1];
    std::sort(begin, end, [](const FaceUse& a, const FaceUse& b) {
      return a.nodes != b.nodes ? a.nodes < b.nodes : a.tet < b.tet;
    });
    for (auto face = begin; face != end;) {
      auto after = face + 1;
      while (after != end && after->nodes == face->nodes) ++after;
      visit(std::span<const FaceUse>(face, after));
      face = after;
    }
  }
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_FACES_H_
