#include "core/surface/visible_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/surface/fragments.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {
namespace {

// A box whose nodes are off the lattice, so that nothing is flat or equal by chance.
TetMesh JitteredBox(int nx, int ny, int nz) {
  TetMesh mesh = KuhnBox({nx, ny, nz}, {1.0 * nx, 1.0 * ny, 1.0 * nz});
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    for (size_t axis = 0; axis < 3; ++axis)
      mesh.rest_positions[node][axis] +=
          0.2 * (UniformDraw(7, RandomStream::kMeshJitter, node, axis) - 0.5);
  }
  return mesh;
}

void ExpectSound(const SurfaceCase& box, const std::vector<int32_t>& broken) {
  const Fragments fragments = FindFragments(box.mesh, box.incidence, broken);
  const double total = std::accumulate(fragments.volumes.begin(), fragments.volumes.end(), 0.0);
  for (const bool smooth : {false, true}) {
    const BrokenSurface surface = box.Extract(broken, smooth);
    ASSERT_NO_FATAL_FAILURE(ExpectClosedOrientedPieces(surface));
    ASSERT_EQ(surface.fragment_count, fragments.count());
    ASSERT_EQ(std::set<int32_t>(surface.fragments.begin(), surface.fragments.end()).size(),
              static_cast<size_t>(fragments.count()));
    const std::vector<double> volumes = EnclosedVolumes(surface, RestPoints(surface));
    ASSERT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0), total, 1e-12 * total);
    if (smooth) continue;
    for (size_t i = 0; i < volumes.size(); ++i)
      ASSERT_NEAR(volumes[i], fragments.volumes[i], 1e-12 * total);
  }
}

TEST(VisibleSurface, OfAnUnbrokenMeshIsItsBoundary) {
  const SurfaceCase box(JitteredBox(4, 3, 2));
  for (const bool smooth : {false, true}) {
    const BrokenSurface surface = box.Extract({}, smooth);
    ASSERT_NO_FATAL_FAILURE(ExpectClosedOrientedPieces(surface));
    ASSERT_EQ(surface.triangles.size(), box.faces.boundary.size());
    EXPECT_EQ(surface.triangles.size(), 2u * 2 * (4 * 3 + 4 * 2 + 3 * 2));
    EXPECT_EQ(surface.points.size(), 5u * 4 * 3 - 3 * 2 * 1);
    for (size_t i = 0; i < surface.triangles.size(); ++i) {
      const TetFace& side = box.faces.boundary[i];
      EXPECT_EQ(surface.tets[i], side.tet);
      EXPECT_EQ(surface.inside[i], 0);
      for (size_t k = 0; k < 3; ++k) {
        const SurfacePoint& point = surface.points[static_cast<size_t>(surface.triangles[i][k])];
        const auto corner = static_cast<size_t>(kTetFaces[static_cast<size_t>(side.face)][k]);
        EXPECT_EQ(point.nodes[0], box.mesh.tets[static_cast<size_t>(side.tet)][corner]);
        EXPECT_EQ(point.node_count, 1);
      }
    }
  }
}

TEST(VisibleSurface, OfRandomBreaksIsClosedAndKeepsVolume) {
  const SurfaceCase small(JitteredBox(2, 2, 1));
  for (uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const double share = 0.1 + 0.8 * static_cast<double>(seed) / 60;
    ASSERT_NO_FATAL_FAILURE(ExpectSound(small, small.RandomEdges(seed, share)));
  }
  const SurfaceCase medium(JitteredBox(9, 8, 7));
  for (uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const double share = 0.3 + 0.08 * static_cast<double>(seed);
    ASSERT_NO_FATAL_FAILURE(ExpectSound(medium, medium.RandomEdges(seed, share)));
  }
}

TEST(VisibleSurface, WithEveryEdgeBrokenIsACellANode) {
  const SurfaceCase box(JitteredBox(3, 2, 2));
  std::vector<int32_t> all(static_cast<size_t>(box.incidence.edge_count()));
  std::iota(all.begin(), all.end(), 0);
  ASSERT_NO_FATAL_FAILURE(ExpectSound(box, all));
  EXPECT_EQ(box.Extract(all).fragment_count, 4 * 3 * 3);
}

TEST(VisibleSurface, ClosesACrackAtItsTip) {
  // A bar cut across its lower half: one piece, with crack faces that part from a whole tip.
  const SurfaceCase bar(JitteredBox(6, 1, 4));
  std::vector<int32_t> cut;
  for (int32_t edge = 0; edge < static_cast<int32_t>(bar.incidence.edge_count()); ++edge) {
    const auto& [a, b] = bar.incidence.edges[static_cast<size_t>(edge)];
    const Vec3& at = bar.mesh.rest_positions[static_cast<size_t>(a)];
    const Vec3& to = bar.mesh.rest_positions[static_cast<size_t>(b)];
    if ((at[0] < 2.5) != (to[0] < 2.5) && std::max(at[2], to[2]) < 2.5) cut.push_back(edge);
  }
  ASSERT_NO_FATAL_FAILURE(ExpectSound(bar, cut));
  const BrokenSurface surface = bar.Extract(cut);
  EXPECT_EQ(surface.fragment_count, 1);
  EXPECT_GT(std::count(surface.inside.begin(), surface.inside.end(), 1), 0);
  bool split = false;
  bool whole = false;
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    if (surface.inside[i] == 0) continue;
    for (const int32_t point : surface.triangles[i]) {
      (surface.points[static_cast<size_t>(point)].owned_by_all() ? whole : split) = true;
    }
  }
  EXPECT_TRUE(split);
  EXPECT_TRUE(whole);
}

TEST(VisibleSurface, ChangesOnlyTrianglesNearACut) {
  const SurfaceCase box(JitteredBox(8, 8, 8));
  const int32_t node = (4 * 9 + 4) * 9 + 4;  // deep inside
  std::vector<int32_t> cut;
  for (const int32_t edge : box.incidence.node_edges[node]) cut.push_back(edge);
  const BrokenSurface surface = box.Extract(cut);
  ASSERT_NO_FATAL_FAILURE(ExpectSound(box, cut));
  EXPECT_EQ(surface.fragment_count, 2);
  // Three quads in each tet of the node, each with two sides of two triangles.
  EXPECT_EQ(surface.triangles.size(),
            box.faces.boundary.size() + 12 * box.incidence.node_tets[node].size());
}

TEST(VisibleSurface, OfTetsJoinedByANodeOnlyIsThatOfEach) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                         {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  const SurfaceCase pair(mesh);
  ExpectSound(pair, {});
  for (uint64_t seed = 0; seed < 20; ++seed) ExpectSound(pair, pair.RandomEdges(seed, 0.6));
}

}  // namespace
}  // namespace cleave
