#include "core/surface/fans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "core/surface/shared_edges.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {
namespace {

std::map<SurfaceId, std::vector<SurfaceId>> PointsByTriangle(const SurfaceTopology& surface) {
  std::map<SurfaceId, std::vector<SurfaceId>> points;
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const int32_t point : surface.triangles[i])
      points[surface.triangle_ids[i]].push_back(surface.point_ids[static_cast<size_t>(point)]);
  }
  return points;
}

TEST(Fans, OfCrackFacesThatTouchInAPointAreParted) {
  const SurfaceCase box(KuhnBox({3, 3, 3}, {3, 3, 3}));
  int64_t parted = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<int32_t> broken =
        box.RandomEdges(seed, 0.1 + 0.04 * static_cast<double>(seed));
    BrokenSurface surface = box.Extract(broken, true);
    const size_t points = surface.points.size();
    const int64_t many = PointsOfManyFans(surface);
    SeparateFans(surface);
    ASSERT_NO_FATAL_FAILURE(ExpectClosedOrientedPieces(surface));
    EXPECT_EQ(PointsOfManyFans(surface), 0);
    EXPECT_GE(surface.points.size(), points + static_cast<size_t>(many));
    EXPECT_EQ(surface.points.size() == points, many == 0);
    parted += many;
  }
  EXPECT_GT(parted, 0);
}

TEST(Fans, OfTetsJoinedByANodeAreParted) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                         {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  const SurfaceCase pair(mesh);
  BrokenSurface surface = pair.Extract({});
  ASSERT_EQ(surface.points.size(), 7u);
  SeparateFans(surface);
  ASSERT_EQ(surface.points.size(), 8u);
  EXPECT_EQ(surface.points[7].rest, (Vec3{0, 0, 0}));
  EXPECT_EQ(surface.point_ids[7], surface_id::OfFan(surface_id::OfNode(0), 1));
  std::set<int32_t> first, second;  // points of either tet
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const int32_t point : surface.triangles[i])
      (surface.tets[i] == 0 ? first : second).insert(point);
  }
  EXPECT_EQ(first.size(), 4u);
  EXPECT_EQ(second.size(), 4u);
  EXPECT_EQ(second.count(7), 1u);
  first.insert(second.begin(), second.end());
  EXPECT_EQ(first.size(), 8u);
}

TEST(Fans, HaveTheSameIdsHoweverTheSurfaceCameToBe) {
  const SurfaceCase box(KuhnBox({3, 3, 3}, {3, 3, 3}));
  const std::vector<int32_t> broken = box.RandomEdges(3, 0.4);
  SurfaceTopology at_once = ExtractSurface(box.mesh, box.incidence, box.faces, broken, {});
  VisibleSurface growing(box.mesh, box.incidence, box.faces, {});
  for (size_t i = broken.size(); i > 0; --i) growing.Break({&broken[i - 1], 1});
  SurfaceTopology grown = growing.topology();
  ASSERT_NE(at_once.triangle_ids, grown.triangle_ids);
  const size_t points = grown.points.size();
  SeparateFans(at_once);
  SeparateFans(grown);
  ASSERT_GT(grown.points.size(), points);
  EXPECT_EQ(PointsByTriangle(at_once), PointsByTriangle(grown));
}

TEST(Fans, OfTetsJoinedByAnEdgeAreParted) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.tets = {{0, 2, 3, 1}, {0, 4, 5, 1}};
  const SurfaceCase pair(mesh);
  BrokenSurface surface = pair.Extract({});
  ASSERT_EQ(SharedEdges(surface), 2);  // there and back
  std::vector<CornerUvs> uvs(8, CornerUvs{{{0, 0}, {1, 0}, {0, 1}}});
  std::vector<int32_t> sources{0, 1, 2, 3, 4, 5, 6, 7};
  SeparateSharedEdges(surface, uvs, sources);
  SeparateFans(surface);
  ASSERT_NO_FATAL_FAILURE(ExpectManifold(surface));
  // Either tet is closed by itself, one of them with a point in the middle of the edge.
  ASSERT_EQ(surface.points.size(), 9u);
  EXPECT_EQ(surface.points[6].rest, (Vec3{0, 0, 0.5}));
  EXPECT_EQ(surface.points[6].node_count, 2);
  EXPECT_TRUE(surface.points[6].owned_by_all());
  ASSERT_EQ(surface.triangles.size(), 10u);
  ASSERT_EQ(uvs.size(), 10u);
  ASSERT_EQ(sources.size(), 10u);
  std::map<int32_t, int> triangles_of_tet, parts_of_source;
  std::map<int32_t, std::set<int32_t>> tets_of_point;
  for (size_t i = 0; i < 10; ++i) {
    ++triangles_of_tet[surface.tets[i]];
    ++parts_of_source[sources[i]];
    for (const int32_t point : surface.triangles[i]) tets_of_point[point].insert(surface.tets[i]);
    // The middle of a side has the middle of its texture coordinates.
    for (size_t k = 0; k < 3; ++k) {
      const bool is_half = surface.triangles[i][k] == 6;
      EXPECT_EQ(uvs[i][k][0] == 0.5f || uvs[i][k][1] == 0.5f, is_half);
    }
  }
  EXPECT_EQ(triangles_of_tet[0] + triangles_of_tet[1], 10);
  EXPECT_EQ(std::abs(triangles_of_tet[0] - triangles_of_tet[1]), 2);
  EXPECT_EQ(parts_of_source.size(), 8u);
  for (const auto& [point, tets] : tets_of_point) EXPECT_EQ(tets.size(), 1u) << point;
}

}  // namespace
}  // namespace cleave
