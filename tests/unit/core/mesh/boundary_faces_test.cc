#include "core/mesh/boundary_faces.h"

#include <gtest/gtest.h>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

// Twice the area vector, m^2.
Vec3 TwiceArea(const TetMesh& mesh, const BoundaryFace& face) {
  Vec3 edges[2];
  for (size_t k = 0; k < 2; ++k) {
    for (size_t axis = 0; axis < 3; ++axis) {
      edges[k][axis] = mesh.rest_positions[static_cast<size_t>(face.nodes[k + 1])][axis] -
                       mesh.rest_positions[static_cast<size_t>(face.nodes[0])][axis];
    }
  }
  return {edges[0][1] * edges[1][2] - edges[0][2] * edges[1][1],
          edges[0][2] * edges[1][0] - edges[0][0] * edges[1][2],
          edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0]};
}

std::vector<int32_t> NodesWhere(const TetMesh& mesh, const auto& inside) {
  std::vector<int32_t> nodes;
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    if (inside(mesh.rest_positions[node])) nodes.push_back(static_cast<int32_t>(node));
  }
  return nodes;
}

TEST(BoundaryFaces, OfAllNodesCloseTheBody) {
  const TetMesh mesh = KuhnBox({3, 2, 4}, {3, 2, 4});
  const auto faces = FindBoundaryFaces(mesh, NodesWhere(mesh, [](const Vec3&) { return true; }));
  EXPECT_EQ(faces.size(), 2u * 2 * (3 * 2 + 2 * 4 + 3 * 4));
  Vec3 sum = {0, 0, 0};
  double volume = 0;
  for (size_t k = 0; k < faces.size(); ++k) {
    const Vec3 area = TwiceArea(mesh, faces[k]);
    const Vec3& corner = mesh.rest_positions[static_cast<size_t>(faces[k].nodes[0])];
    for (size_t axis = 0; axis < 3; ++axis) {
      sum[axis] += area[axis];
      volume += corner[axis] * area[axis] / 6;
    }
    EXPECT_LE(faces[k > 0 ? k - 1 : 0].tet, faces[k].tet);
  }
  for (const double component : sum) EXPECT_NEAR(component, 0, 1e-12);
  EXPECT_NEAR(volume, 24, 1e-12);  // positive: they turn outward
}

TEST(BoundaryFaces, OfASideAreThatSideAlone) {
  const TetMesh mesh = KuhnBox({3, 2, 4}, {3, 2, 4});
  const auto faces =
      FindBoundaryFaces(mesh, NodesWhere(mesh, [](const Vec3& x) { return x[0] == 3; }));
  EXPECT_EQ(faces.size(), 2u * 2 * 4);
  for (const BoundaryFace& face : faces) EXPECT_EQ(TwiceArea(mesh, face), (Vec3{1, 0, 0}));
}

TEST(BoundaryFaces, InsideTheBodyAreNone) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {4, 2, 2});
  // A cross-section touches the boundary along a line only; two nodes make no face.
  EXPECT_TRUE(
      FindBoundaryFaces(mesh, NodesWhere(mesh, [](const Vec3& x) { return x[0] == 2; })).empty());
  EXPECT_TRUE(FindBoundaryFaces(mesh, std::vector<int32_t>{0, 1}).empty());
}

}  // namespace
}  // namespace cleave
