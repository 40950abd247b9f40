// Surfaces that grow as edges break: the same as those taken at once, under ids that last.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {
namespace {

// What a surface holds, wherever in the arrays it stands.
struct Records {
  struct Triangle {
    std::array<SurfaceId, 3> points;  // turned so that the smallest comes first
    int32_t node, tet;
    bool inside;
    bool operator==(const Triangle&) const = default;
  };
  struct Point {
    Vec3 rest;
    std::array<int32_t, 4> nodes;
    std::array<double, 4> weights;
    uint8_t node_count, owners;
    bool operator==(const Point&) const = default;
  };
  std::map<SurfaceId, Triangle> triangles;
  std::map<SurfaceId, Point> points;
  std::vector<EdgeMask> masks;
  bool operator==(const Records&) const = default;
};

Records RecordsOf(const SurfaceTopology& surface) {
  Records records;
  records.masks = surface.tet_masks;
  for (size_t i = 0; i < surface.points.size(); ++i) {
    const SurfacePoint& point = surface.points[i];
    records.points[surface.point_ids[i]] = {point.rest, point.nodes, point.weights,
                                            point.node_count, point.owners};
  }
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    std::array<SurfaceId, 3> ids{};
    for (size_t k = 0; k < 3; ++k)
      ids[k] = surface.point_ids[static_cast<size_t>(surface.triangles[i][k])];
    std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
    records.triangles[surface.triangle_ids[i]] = {ids, surface.nodes[i], surface.tets[i],
                                                  surface.inside[i] != 0};
  }
  return records;
}

// The edges in a random order, in `parts` parts.
std::vector<std::vector<int32_t>> Dealt(std::vector<int32_t> edges, uint64_t seed, size_t parts) {
  std::vector<std::vector<int32_t>> dealt(parts);
  for (const int32_t edge : edges) {
    const double draw =
        UniformDraw(seed, RandomStream::kMeshJitter, static_cast<uint64_t>(edge), 5);
    dealt[std::min(parts - 1, static_cast<size_t>(draw * static_cast<double>(parts)))].push_back(
        edge);
  }
  return dealt;
}

void ExpectGrowsAsTaken(const SurfaceCase& box, uint64_t seed, double share, size_t parts) {
  for (const bool smooth : {false, true}) {
    VisibleSurface surface(box.mesh, box.incidence, box.faces, {.smooth = smooth});
    std::vector<int32_t> broken;
    for (const std::vector<int32_t>& edges : Dealt(box.RandomEdges(seed, share), seed, parts)) {
      surface.Break(edges);
      broken.insert(broken.end(), edges.begin(), edges.end());
      std::sort(broken.begin(), broken.end());
      ASSERT_NO_FATAL_FAILURE(
          ExpectClosedOrientedPieces(box.WithPieces(surface.topology(), broken)));
      ASSERT_TRUE(RecordsOf(surface.topology()) == RecordsOf(box.Extract(broken, smooth)))
          << broken.size() << " edges";
    }
  }
}

TEST(SurfaceGrowth, EndsWhereASurfaceTakenAtOnceIs) {
  const SurfaceCase small(KuhnBox({2, 2, 2}, {1, 1.2, 0.9}));
  for (uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const double share = 0.1 + 0.85 * static_cast<double>(seed) / 40;
    ASSERT_NO_FATAL_FAILURE(ExpectGrowsAsTaken(small, seed, share, 12));
  }
  const SurfaceCase medium(KuhnBox({6, 5, 4}, {6, 5, 4}));
  for (uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    ASSERT_NO_FATAL_FAILURE(
        ExpectGrowsAsTaken(medium, seed, 0.35 + 0.15 * static_cast<double>(seed), 6));
  }
}

TEST(SurfaceGrowth, OneEdgeAtATimeThroughAllOrdersOfATetsEdges) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.9, 0.8, 0.7}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  const SurfaceCase pair(mesh);
  std::vector<int32_t> order(6);
  for (size_t k = 0; k < 6; ++k) order[k] = pair.incidence.tet_edges[0][k];
  std::sort(order.begin(), order.end());
  do {
    VisibleSurface surface(pair.mesh, pair.incidence, pair.faces, {});
    std::vector<int32_t> broken;
    for (const int32_t edge : order) {
      surface.Break(std::vector<int32_t>{edge});
      broken.push_back(edge);
    }
    ASSERT_TRUE(RecordsOf(surface.topology()) == RecordsOf(pair.Extract(broken, true)));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(SurfaceGrowth, WhatHasAnIdKeepsItWhileOthersCrack) {
  const SurfaceCase box(KuhnBox({6, 6, 6}, {6, 6, 6}));
  VisibleSurface surface(box.mesh, box.incidence, box.faces, {});
  std::map<SurfaceId, Records::Triangle> before = RecordsOf(surface.topology()).triangles;
  // Once a crack face is there it stays; an outer triangle stays until its own face is cut anew.
  for (const std::vector<int32_t>& edges : Dealt(box.RandomEdges(3, 0.5), 3, 10)) {
    surface.Break(edges);
    const Records records = RecordsOf(surface.topology());
    size_t kept = 0;
    for (const auto& [id, triangle] : before) {
      const auto now = records.triangles.find(id);
      if (now == records.triangles.end()) {
        // Of crack faces, only a pinch point that comes or goes makes others.
        const SurfaceId whole = id & ~SurfaceId{3};
        ASSERT_TRUE(!triangle.inside || records.triangles.contains(whole) ||
                    records.triangles.contains(whole | 1));
        continue;
      }
      ++kept;
      ASSERT_EQ(now->second.tet, triangle.tet);
      ASSERT_EQ(now->second.inside, triangle.inside);
      if (triangle.inside) {
        ASSERT_EQ(now->second.node, triangle.node);
      }
    }
    ASSERT_GT(kept, before.size() * 2 / 3);
    before = records.triangles;
  }
}

TEST(SurfaceGrowth, TakesTheWorkOfWhatBrokeAndNotOfTheMesh) {
  // The edges of one node deep inside, in boxes of growing size.
  std::vector<int64_t> work;
  for (const int n : {6, 12}) {
    const SurfaceCase box(KuhnBox({n, n, n}, {1.0 * n, 1.0 * n, 1.0 * n}));
    VisibleSurface surface(box.mesh, box.incidence, box.faces, {});
    const int32_t node = ((n / 2) * (n + 1) + n / 2) * (n + 1) + n / 2;
    const std::span<const int32_t> edges = box.incidence.node_edges[node];
    work.push_back(surface.Break(edges));
    const size_t triangles = surface.topology().triangles.size();
    // Edges that part nothing more are no work at all.
    const auto [a, b] = box.incidence.edges[static_cast<size_t>(edges.front())];
    const int32_t other = a == node ? b : a;
    int32_t harmless = -1;
    for (const int32_t edge : box.incidence.node_edges[other]) {
      if (std::find(edges.begin(), edges.end(), edge) == edges.end()) harmless = edge;
    }
    EXPECT_EQ(surface.Break(std::vector<int32_t>{harmless}), 0);
    EXPECT_EQ(surface.topology().triangles.size(), triangles);
  }
  EXPECT_EQ(work[0], work[1]);
  EXPECT_LE(work[0], 24);
}

}  // namespace
}  // namespace cleave
