#ifndef CLEAVE_TESTS_UNIT_CORE_MESH_KUHN_MESH_H_
#define CLEAVE_TESTS_UNIT_CORE_MESH_KUHN_MESH_H_

#include <array>
#include <cstdint>

#include "core/mesh/tet_geometry.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// A box from the origin of nx, ny, nz cells, each split into six tets along its main diagonal, one
// per permutation of the axes. Node (i, j, k) has id (i * (ny + 1) + j) * (nz + 1) + k.
inline TetMesh KuhnBox(std::array<int, 3> cells, Vec3 size, Vec3 origin = {0, 0, 0}) {
  TetMesh mesh;
  const auto node = [&](std::array<int, 3> at) {
    return (at[0] * (cells[1] + 1) + at[1]) * (cells[2] + 1) + at[2];
  };
  for (int i = 0; i <= cells[0]; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int k = 0; k <= cells[2]; ++k) {
        mesh.rest_positions.push_back({origin[0] + size[0] * i / cells[0],
                                       origin[1] + size[1] * j / cells[1],
                                       origin[2] + size[2] * k / cells[2]});
      }
    }
  }
  constexpr int kPermutations[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                       {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int i = 0; i < cells[0]; ++i) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int k = 0; k < cells[2]; ++k) {
        for (const auto& permutation : kPermutations) {
          std::array<int, 3> at = {i, j, k};
          std::array<int32_t, 4> tet = {node(at), 0, 0, 0};
          for (size_t step = 0; step < 3; ++step) {
            ++at[static_cast<size_t>(permutation[step])];
            tet[step + 1] = node(at);
          }
          mesh.tets.push_back(tet);
          if (SignedVolume(CornersOf(mesh, mesh.tet_count() - 1)) < 0)
            std::swap(mesh.tets.back()[2], mesh.tets.back()[3]);
        }
      }
    }
  }
  return mesh;
}

// Adds another mesh beside what is there: its ids follow. Regions are left out.
inline void AppendMesh(TetMesh& mesh, const TetMesh& other) {
  const auto offset = static_cast<int32_t>(mesh.node_count());
  mesh.rest_positions.insert(mesh.rest_positions.end(), other.rest_positions.begin(),
                             other.rest_positions.end());
  for (auto tet : other.tets) {
    for (int32_t& node : tet) node += offset;
    mesh.tets.push_back(tet);
  }
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_MESH_KUHN_MESH_H_
