#include "core/mesh/body_centred_lattice.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/counter_rng.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

// Edges are 0.923 of the cubes' sides on the mean.
constexpr double kCubeSide = 1 / 0.923;
// Of a cube's side: how far a jitter of 1 would move a node along an axis. The largest, 0.4, turns
// no tet over.
constexpr double kJitterReach = 0.4;

void OrientAll(TetMesh& mesh) {
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    auto& nodes = mesh.tets[static_cast<size_t>(tet)];
    if (SignedVolume(CornersOf(mesh, tet)) < 0) std::swap(nodes[2], nodes[3]);
  }
}

}  // namespace

TetMesh BodyCentredLattice(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                           const MeshResolution& resolution) {
  const double side = kCubeSide * resolution.cell_size;
  std::array<int64_t, 3> cubes;
  for (int axis = 0; axis < 3; ++axis)
    cubes[static_cast<size_t>(axis)] =
        static_cast<int64_t>(std::ceil((high[axis] - low[axis]) / side)) + 1;
  const auto corner = [&](int64_t i, int64_t j, int64_t k) {
    return static_cast<int32_t>((i * (cubes[1] + 1) + j) * (cubes[2] + 1) + k);
  };
  const int32_t corners = corner(cubes[0], cubes[1], cubes[2]) + 1;
  const auto middle = [&](int64_t i, int64_t j, int64_t k) {
    return corners + static_cast<int32_t>((i * cubes[1] + j) * cubes[2] + k);
  };
  TetMesh mesh;
  const auto add = [&](int64_t i, int64_t j, int64_t k, double shift) {
    const auto node = static_cast<uint64_t>(mesh.rest_positions.size());
    const Eigen::Vector3d in_cubes(static_cast<double>(i) + shift, static_cast<double>(j) + shift,
                                   static_cast<double>(k) + shift);
    Vec3 place;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double draw = UniformDraw(resolution.seed, RandomStream::kMeshJitter, node, axis);
      const auto a = static_cast<int>(axis);
      place[axis] =
          low[a] + side * (in_cubes[a] - 0.5 + kJitterReach * resolution.jitter * (2 * draw - 1));
    }
    mesh.rest_positions.push_back(place);
  };
  for (int64_t i = 0; i <= cubes[0]; ++i)
    for (int64_t j = 0; j <= cubes[1]; ++j)
      for (int64_t k = 0; k <= cubes[2]; ++k) add(i, j, k, 0);
  for (int64_t i = 0; i < cubes[0]; ++i)
    for (int64_t j = 0; j < cubes[1]; ++j)
      for (int64_t k = 0; k < cubes[2]; ++k) add(i, j, k, 0.5);
  for (int64_t i = 0; i < cubes[0]; ++i) {
    for (int64_t j = 0; j < cubes[1]; ++j) {
      for (int64_t k = 0; k < cubes[2]; ++k) {
        for (size_t axis = 0; axis < 3; ++axis) {
          std::array<int64_t, 3> next = {i, j, k};
          if (++next[axis] == cubes[axis]) continue;
          // The corners of the face, round it.
          std::array<int32_t, 4> face;
          for (size_t turn = 0; turn < 4; ++turn) {
            std::array<int64_t, 3> at = next;
            at[(axis + 1) % 3] += turn == 1 || turn == 2 ? 1 : 0;
            at[(axis + 2) % 3] += turn >= 2 ? 1 : 0;
            face[turn] = corner(at[0], at[1], at[2]);
          }
          for (size_t turn = 0; turn < 4; ++turn) {
            mesh.tets.push_back({middle(i, j, k), middle(next[0], next[1], next[2]), face[turn],
                                 face[(turn + 1) % 4]});
          }
        }
      }
    }
  }
  OrientAll(mesh);
  return mesh;
}

}  // namespace cleave
