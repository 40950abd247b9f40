#include "core/surface/divided_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/core/surface/fine_box.h"

namespace cleave {
namespace {

constexpr Vec3 kSize{2, 1.2, 1};

double Distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(DividedMesh, LongEdgesAreHalvedUntilNodesOfTheirEndsAreJoined) {
  const SurfaceCase box(KuhnBox({6, 4, 3}, kSize));
  const RenderMesh coarse = FineBox({1, 1, 1}, kSize, [](const Vec3& at) { return at; });
  const DividedMesh divided(box.mesh, box.incidence, box.faces, coarse);
  EXPECT_GT(divided.mesh().triangles.size(), 50 * coarse.triangles.size());
  EXPECT_EQ(CountOpenEdges(divided.mesh().triangles), 0);
  for (size_t edge = 0; edge < divided.edges().size(); ++edge) {
    const auto [a, b] = divided.edges()[edge];
    // The mean edge of these tets is about 0.43 long.
    EXPECT_LT(Distance(divided.mesh().points[static_cast<size_t>(a)],
                       divided.mesh().points[static_cast<size_t>(b)]),
              0.23);
    const int32_t from = divided.label(static_cast<size_t>(a));
    const int32_t to = divided.label(static_cast<size_t>(b));
    if (from == to) continue;
    EXPECT_GE(divided.FindEdge(from, to), 0);
    EXPECT_GE(divided.CutShare(edge), 0.02);
    EXPECT_LE(divided.CutShare(edge), 0.98);
  }
  for (size_t i = 0; i < divided.mesh().triangles.size(); ++i) {
    ASSERT_LT(static_cast<size_t>(divided.source(i)), coarse.triangles.size());
    const auto [a, b, c] = divided.LabelsOf(i);
    if (a == b || b == c || c == a) continue;
    EXPECT_GE(divided.FindFace({a, b, c}), 0);
  }
}

TEST(DividedMesh, GivenPointsStayAndTextureIsDividedAlong) {
  const SurfaceCase box(KuhnBox({6, 4, 3}, kSize));
  const RenderMesh coarse = FineBox({2, 1, 1}, kSize, [](const Vec3& at) { return at; });
  const DividedMesh divided(box.mesh, box.incidence, box.faces, coarse);
  for (size_t i = 0; i < coarse.points.size(); ++i)
    EXPECT_EQ(divided.mesh().points[i], coarse.points[i]);
  ASSERT_EQ(divided.mesh().uvs.size(), divided.mesh().triangles.size());
  for (size_t i = 0; i < divided.mesh().triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& at = divided.mesh().points[static_cast<size_t>(divided.mesh().triangles[i][k])];
      EXPECT_NEAR(divided.mesh().uvs[i][k][0], at[0], 1e-6);
      EXPECT_NEAR(divided.mesh().uvs[i][k][1], at[1], 1e-6);
    }
  }
}

TEST(DividedMesh, PointsBelongToTheNodeThatWeighsMost) {
  const SurfaceCase box(KuhnBox({6, 4, 3}, kSize));
  const DividedMesh divided(box.mesh, box.incidence, box.faces,
                            FineBox({6, 4, 3}, kSize, [](const Vec3& at) { return at; }));
  // Its corners are nodes of the body.
  for (size_t i = 0; i < 8; ++i) {
    const auto node = static_cast<size_t>(divided.label(i));
    EXPECT_LT(Distance(divided.mesh().points[i], box.mesh.rest_positions[node]), 1e-9);
  }
}

}  // namespace
}  // namespace cleave
