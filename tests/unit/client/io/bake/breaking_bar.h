#ifndef CLEAVE_TESTS_UNIT_CLIENT_IO_BAKE_BREAKING_BAR_H_
#define CLEAVE_TESTS_UNIT_CLIENT_IO_BAKE_BREAKING_BAR_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/io/series/frame_source.h"
#include "core/damage/named_pieces.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"

namespace cleave::testing {

// A bar of 4 x 2 x 2 cubes of 0.5 m along x, six tets each; the right half is region 7, "crust".
inline TetMesh BarMesh() {
  constexpr int kX = 4, kY = 2, kZ = 2;
  TetMesh mesh;
  const auto node = [](int x, int y, int z) { return (x * (kY + 1) + y) * (kZ + 1) + z; };
  for (int x = 0; x <= kX; ++x) {
    for (int y = 0; y <= kY; ++y) {
      for (int z = 0; z <= kZ; ++z) mesh.rest_positions.push_back({0.5 * x, 0.5 * y, 0.5 * z});
    }
  }
  // Kuhn's tets: from the lowest corner to the highest, an axis after the other.
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int x = 0; x < kX; ++x) {
    for (int y = 0; y < kY; ++y) {
      for (int z = 0; z < kZ; ++z) {
        for (size_t k = 0; k < kOrders.size(); ++k) {
          std::array<int, 3> at{x, y, z};
          std::array<int32_t, 4> tet{};
          tet[0] = node(at[0], at[1], at[2]);
          for (size_t i = 0; i < 3; ++i) {
            ++at[static_cast<size_t>(kOrders[k][i])];
            tet[i + 1] = node(at[0], at[1], at[2]);
          }
          if (k >= 3) std::swap(tet[0], tet[1]);
          mesh.tets.push_back(tet);
          mesh.tet_regions.push_back(x < kX / 2 ? 3 : 7);
        }
      }
    }
  }
  mesh.regions = {{7, "crust"}};
  return mesh;
}

// The bar's middle, x in (0.5, 1.5), cracks from below: at frame 2 its lower edges are broken, at
// frame 4 all that cross x = 0.75, so that the right part flies off. Frames are 0.1 s apart.
inline Frame BarFrame(const TetMesh& mesh, int64_t position) {
  Frame frame;
  frame.frame = 10 + position;
  frame.time = 1 + 0.1 * static_cast<double>(position);
  const Incidence incidence = BuildIncidence(mesh);
  const double t = static_cast<double>(position);
  for (const Vec3& rest : mesh.rest_positions) {
    // Bent and stretched, smoothly at first.
    Vec3 moved = {rest[0] * (1 + 0.02 * t), rest[1], rest[2] + 0.03 * t * rest[0] * rest[0]};
    if (position >= 4 && rest[0] > 0.75) {
      moved[0] += 0.2 * (t - 3);
      moved[2] -= 0.1 * (t - 3);
    }
    frame.positions.push_back(moved);
  }
  for (int32_t edge = 0; edge < incidence.edge_count() && position >= 2; ++edge) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    const Vec3& p = mesh.rest_positions[static_cast<size_t>(a)];
    const Vec3& q = mesh.rest_positions[static_cast<size_t>(b)];
    const bool crosses = (p[0] < 0.75) != (q[0] < 0.75);
    if (crosses && (position >= 4 || std::max(p[2], q[2]) < 0.75)) {
      frame.broken_edges.push_back(edge);
    }
  }
  return frame;
}

// The bar's pieces after `count` frames.
inline NamedPieces PiecesOfBar(const TetMesh& mesh, const Incidence& incidence, int64_t count) {
  NamedPieces pieces(mesh, incidence);
  for (int64_t position = 0; position < count; ++position) {
    pieces.Break(BarFrame(mesh, position).broken_edges);
  }
  return pieces;
}

inline FrameSource BreakingBar(const TetMesh& mesh, int64_t count = 6) {
  FrameSource source;
  source.count = count;
  source.read = [&mesh](int64_t position) -> absl::StatusOr<Frame> {
    return BarFrame(mesh, position);
  };
  return source;
}

}  // namespace cleave::testing

#endif  // CLEAVE_TESTS_UNIT_CLIENT_IO_BAKE_BREAKING_BAR_H_
