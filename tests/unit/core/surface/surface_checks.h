#ifndef CLEAVE_TESTS_UNIT_CORE_SURFACE_SURFACE_CHECKS_H_
#define CLEAVE_TESTS_UNIT_CORE_SURFACE_SURFACE_CHECKS_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/mesh/render_mesh.h"
#include "core/surface/fragments.h"
#include "core/surface/visible_surface.h"

namespace cleave {

// A surface with its pieces, as FindFragments numbers them.
struct BrokenSurface : SurfaceTopology {
  std::vector<int32_t> fragments;  // a triangle each
  std::vector<int32_t> node_fragments;
  int32_t fragment_count = 0;
};

// A mesh with everything that extraction needs beside it.
struct SurfaceCase {
  explicit SurfaceCase(TetMesh tets)
      : mesh(std::move(tets)), incidence(BuildIncidence(mesh)), faces(BuildFaces(mesh)) {}
  BrokenSurface WithPieces(SurfaceTopology topology, const std::vector<int32_t>& broken) const {
    BrokenSurface surface{std::move(topology), {}, {}, 0};
    Fragments fragments = FindFragments(mesh, incidence, broken);
    surface.fragment_count = fragments.count();
    surface.node_fragments = std::move(fragments.node_fragments);
    for (const int32_t node : surface.nodes)
      surface.fragments.push_back(surface.node_fragments[static_cast<size_t>(node)]);
    return surface;
  }
  BrokenSurface Extract(const std::vector<int32_t>& broken, bool smooth = false) const {
    return WithPieces(ExtractSurface(mesh, incidence, faces, broken, {.smooth = smooth}), broken);
  }
  // Breaks each edge with the given probability.
  std::vector<int32_t> RandomEdges(uint64_t seed, double share) const {
    std::vector<int32_t> edges;
    for (int32_t edge = 0; edge < static_cast<int32_t>(incidence.edge_count()); ++edge) {
      if (UniformDraw(seed, RandomStream::kEdgeDraw, static_cast<uint64_t>(edge), 0) < share)
        edges.push_back(edge);
    }
    return edges;
  }

  TetMesh mesh;
  Incidence incidence;
  Faces faces;
};

inline std::vector<Vec3> RestPoints(const SurfaceTopology& surface) {
  std::vector<Vec3> points;
  for (const SurfacePoint& point : surface.points) points.push_back(point.rest);
  return points;
}

// The volume inside each fragment's triangles, m^3.
inline std::vector<double> EnclosedVolumes(const BrokenSurface& surface,
                                           const std::vector<Vec3>& points) {
  std::vector<double> volumes(static_cast<size_t>(surface.fragment_count), 0.0);
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& [pa, pb, pc] = surface.triangles[i];
    const Vec3& a = points[static_cast<size_t>(pa)];
    const Vec3& b = points[static_cast<size_t>(pb)];
    const Vec3& c = points[static_cast<size_t>(pc)];
    volumes[static_cast<size_t>(surface.fragments[i])] +=
        (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0])) /
        6;
  }
  return volumes;
}

// Every directed edge lies in one triangle and its reverse in another; fragments share no points;
// every point is in use; arrays fit.
inline void ExpectClosedOrientedPieces(const BrokenSurface& surface) {
  ASSERT_EQ(surface.fragments.size(), surface.triangles.size());
  ASSERT_EQ(surface.tets.size(), surface.triangles.size());
  ASSERT_EQ(surface.inside.size(), surface.triangles.size());
  ASSERT_EQ(surface.triangle_ids.size(), surface.triangles.size());
  ASSERT_EQ(surface.point_ids.size(), surface.points.size());
  using Ids = std::set<SurfaceId>;
  ASSERT_EQ(Ids(surface.triangle_ids.begin(), surface.triangle_ids.end()).size(),
            surface.triangles.size());
  ASSERT_EQ(Ids(surface.point_ids.begin(), surface.point_ids.end()).size(), surface.points.size());
  std::map<std::pair<int32_t, int32_t>, int> uses;
  std::vector<int32_t> fragment_of(surface.points.size(), -1);
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const int32_t a = surface.triangles[i][k];
      const int32_t b = surface.triangles[i][(k + 1) % 3];
      ASSERT_GE(a, 0);
      ASSERT_LT(static_cast<size_t>(a), surface.points.size());
      ASSERT_EQ(++uses[std::pair(a, b)], 1) << "edge " << a << " " << b << " is used twice";
      int32_t& fragment = fragment_of[static_cast<size_t>(a)];
      ASSERT_TRUE(fragment == -1 || fragment == surface.fragments[i]) << "a shared point " << a;
      fragment = surface.fragments[i];
    }
  }
  for (const auto& [edge, count] : uses)
    ASSERT_TRUE(uses.contains({edge.second, edge.first})) << edge.first << " " << edge.second;
  for (size_t point = 0; point < fragment_of.size(); ++point)
    ASSERT_NE(fragment_of[point], -1) << "point " << point << " is in no triangle";
}

// How many points lie in more than one fan: whoever walks round such a point from edge to edge is
// back before all of its triangles were seen. Precondition: every directed edge lies in one
// triangle and its reverse in another.
inline int64_t PointsOfManyFans(const SurfaceTopology& surface) {
  // The two other corners of each triangle at a point, in its order.
  std::vector<std::vector<std::pair<int32_t, int32_t>>> rounds(surface.points.size());
  for (const auto& triangle : surface.triangles) {
    for (size_t k = 0; k < 3; ++k)
      rounds[static_cast<size_t>(triangle[k])].emplace_back(triangle[(k + 1) % 3],
                                                            triangle[(k + 2) % 3]);
  }
  int64_t many = 0;
  for (const auto& round : rounds) {
    size_t seen = 0;
    int32_t at = round.front().first;
    do {
      at = std::find_if(round.begin(), round.end(), [&](const auto& next) {
             return next.first == at;
           })->second;
      ++seen;
    } while (at != round.front().first);
    if (seen < round.size()) ++many;
  }
  return many;
}

// Directed edges that lie in more than one triangle.
inline int64_t SharedEdges(const SurfaceTopology& surface) {
  std::vector<std::pair<int32_t, int32_t>> edges;
  for (const auto& triangle : surface.triangles) {
    for (size_t k = 0; k < 3; ++k) edges.emplace_back(triangle[k], triangle[(k + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  int64_t shared = 0;
  for (size_t i = 1; i < edges.size(); ++i) {
    const bool is_first = i == 1 || edges[i - 1] != edges[i - 2];
    shared += edges[i] == edges[i - 1] && is_first ? 1 : 0;
  }
  return shared;
}

inline bool AreApart(std::vector<SurfaceId> ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) == ids.end();
}

// Every directed edge in one triangle, its reverse in another, one fan round each point, ids apart.
inline void ExpectManifold(const SurfaceTopology& surface) {
  ASSERT_EQ(SharedEdges(surface), 0);
  ASSERT_EQ(CountOpenEdges(surface.triangles), 0);
  ASSERT_EQ(PointsOfManyFans(surface), 0);
  ASSERT_EQ(surface.triangle_ids.size(), surface.triangles.size());
  ASSERT_EQ(surface.point_ids.size(), surface.points.size());
  ASSERT_TRUE(AreApart(surface.triangle_ids));
  ASSERT_TRUE(AreApart(surface.point_ids));
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_SURFACE_SURFACE_CHECKS_H_
