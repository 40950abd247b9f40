#include "core/surface/fans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {
namespace {

// How many points lie in more than one fan: whoever walks round such a point from edge to edge is
// back before all of its triangles were seen. Precondition: ExpectClosedOrientedPieces.
int64_t PointsOfManyFans(const SurfaceTopology& surface) {
  std::vector<std::map<int32_t, int32_t>> next(surface.points.size());
  for (const auto& triangle : surface.triangles) {
    for (size_t k = 0; k < 3; ++k)
      next[static_cast<size_t>(triangle[k])][triangle[(k + 1) % 3]] = triangle[(k + 2) % 3];
  }
  int64_t many = 0;
  for (const auto& round : next) {
    size_t seen = 0;
    int32_t at = round.begin()->first;
    do {
      at = round.at(at);
      ++seen;
    } while (at != round.begin()->first);
    if (seen < round.size()) ++many;
  }
  return many;
}

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

}  // namespace
}  // namespace cleave
