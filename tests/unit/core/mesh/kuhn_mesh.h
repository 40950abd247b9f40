#ifndef CLEAVE_TESTS_UNIT_CORE_MESH_KUHN_MESH_H_
#define CLEAVE_TESTS_UNIT_CORE_MESH_KUHN_MESH_H_

#include <algorithm>
#include <array>

#include "core/mesh/tet_mesh.h"

namespace cleave {

// A box of nx x ny x nz cells with a corner at the origin, each cell split into six tets along its
// main diagonal, one for each order of the axes: the mesh of the reference values.
inline TetMesh KuhnMesh(int nx, int ny, int nz, const Vec3& size) {
  TetMesh mesh;
  const std::array<int, 3> cells{nx, ny, nz};
  const auto node_id = [&](const std::array<int, 3>& at) {
    return (at[0] * (ny + 1) + at[1]) * (nz + 1) + at[2];
  };
  std::array<int, 3> at{};
  for (at[0] = 0; at[0] <= nx; ++at[0])
    for (at[1] = 0; at[1] <= ny; ++at[1])
      for (at[2] = 0; at[2] <= nz; ++at[2])
        mesh.rest_positions.push_back(
            {size[0] * at[0] / nx, size[1] * at[1] / ny, size[2] * at[2] / nz});
  for (at[0] = 0; at[0] < cells[0]; ++at[0]) {
    for (at[1] = 0; at[1] < cells[1]; ++at[1]) {
      for (at[2] = 0; at[2] < cells[2]; ++at[2]) {
        std::array<size_t, 3> axes{0, 1, 2};
        bool even = true;
        do {
          std::array<int, 3> walk = at;
          std::array<int32_t, 4> tet{node_id(walk)};
          for (size_t step = 0; step < 3; ++step) {
            ++walk[axes[step]];
            tet[step + 1] = node_id(walk);
          }
          // Going through permutations in order, signs alternate + - - + + -.
          even = (axes[0] < axes[1]) == ((axes[1] < axes[2]) == (axes[0] < axes[2]));
          if (!even) std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
    }
  }
  return mesh;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_MESH_KUHN_MESH_H_
