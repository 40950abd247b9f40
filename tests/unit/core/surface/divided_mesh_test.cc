#include "core/surface/divided_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
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

// Barycentric, in coordinates that numbers do not hold exactly.
std::array<double, 4> WeightsIn(const TetMesh& mesh, size_t tet, const Vec3& point) {
  std::array<Eigen::Vector3d, 4> at;
  for (size_t k = 0; k < 4; ++k)
    at[k] = Eigen::Vector3d(mesh.rest_positions[static_cast<size_t>(mesh.tets[tet][k])].data());
  Eigen::Matrix3d edges;
  edges << at[1] - at[0], at[2] - at[0], at[3] - at[0];
  const Eigen::Vector3d inner = edges.inverse() * (Eigen::Vector3d(point.data()) - at[0]);
  return {1 - inner.sum(), inner[0], inner[1], inner[2]};
}

// Round-off decides nothing: client/python/cleave/embedded.py goes by the same rule.
TEST(DividedMesh, PointsBetweenTetsAndNodesGoWithTheLowest) {
  TetMesh mesh = KuhnBox({3, 2, 2}, {3.0 / 7, 2.0 / 7, 2.0 / 7});
  const Vec3 low{0.1, 0.1, 0.1}, high{0.1 + 3.0 / 7, 0.1 + 2.0 / 7, 0.1 + 2.0 / 7};
  for (Vec3& at : mesh.rest_positions) {
    for (double& coordinate : at) coordinate += 0.1;
  }
  const SurfaceCase box(std::move(mesh));
  RenderMesh render;
  for (const auto& tet : box.mesh.tets) {
    for (size_t k = 0; k < 4; ++k) {
      const Vec3& a = box.mesh.rest_positions[static_cast<size_t>(tet[k])];
      const Vec3& b = box.mesh.rest_positions[static_cast<size_t>(tet[(k + 1) % 4])];
      Vec3 middle{}, beyond{};
      for (size_t axis = 0; axis < 3; ++axis) {
        middle[axis] = (a[axis] + b[axis]) / 2;
        beyond[axis] = 0.3 + 1.7 * (middle[axis] - 0.3);
      }
      render.points.insert(render.points.end(), {a, middle, beyond});
    }
  }
  render.triangles = {{0, 1, 2}};
  const DividedMesh divided(box.mesh, box.incidence, box.faces, render);
  int64_t outside = 0;
  for (size_t i = 0; i < render.points.size(); ++i) {
    // The nearest point of a box, and the tets that have it on a face of theirs of the boundary.
    Vec3 nearest = render.points[i];
    for (size_t axis = 0; axis < 3; ++axis)
      nearest[axis] = std::clamp(nearest[axis], low[axis], high[axis]);
    const bool is_outside = Distance(nearest, render.points[i]) > 1e-6;
    outside += is_outside ? 1 : 0;
    int32_t lowest = -1;
    for (size_t tet = 0; tet < box.mesh.tets.size() && lowest < 0; ++tet) {
      const std::array<double, 4> weights = WeightsIn(box.mesh, tet, nearest);
      bool counts = !is_outside;
      for (size_t k = 0; k < 4; ++k) counts |= weights[k] < 1e-6 && box.faces.neighbors[tet][k] < 0;
      if (counts && *std::min_element(weights.begin(), weights.end()) > -1e-6)
        lowest = static_cast<int32_t>(tet);
    }
    ASSERT_EQ(divided.place(i).tet, lowest) << i;
    const auto& nodes = box.mesh.tets[static_cast<size_t>(lowest)];
    const std::array<double, 4> weights =
        WeightsIn(box.mesh, static_cast<size_t>(lowest), render.points[i]);
    int32_t own = std::numeric_limits<int32_t>::max();
    for (size_t k = 0; k < 4; ++k) {
      if (weights[k] > *std::max_element(weights.begin(), weights.end()) - 1e-6)
        own = std::min(own, nodes[k]);
    }
    EXPECT_EQ(divided.label(i), own) << i;
  }
  EXPECT_GT(outside, 100);
}

}  // namespace
}  // namespace cleave
