#include "core/mesh/incidence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace cleave {
namespace {

using ::testing::ElementsAre;

// Two tets on a common face.
TetMesh TwoTets() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  return mesh;
}

TEST(Incidence, NumbersEdgesByTheirNodes) {
  const Incidence incidence = BuildIncidence(TwoTets());
  ASSERT_EQ(incidence.edge_count(), 9);
  EXPECT_TRUE(std::is_sorted(incidence.edges.begin(), incidence.edges.end()));
  EXPECT_EQ(incidence.edges.front(), (std::array<int32_t, 2>{0, 1}));
  EXPECT_EQ(incidence.edges.back(), (std::array<int32_t, 2>{3, 4}));
}

TEST(Incidence, TetEdgesFollowTheOrderOfMasks) {
  const TetMesh mesh = TwoTets();
  const Incidence incidence = BuildIncidence(mesh);
  for (size_t tet = 0; tet < 2; ++tet) {
    for (size_t k = 0; k < 6; ++k) {
      const int32_t a = mesh.tets[tet][static_cast<size_t>(kTetEdges[k][0])];
      const int32_t b = mesh.tets[tet][static_cast<size_t>(kTetEdges[k][1])];
      EXPECT_EQ(incidence.edges[static_cast<size_t>(incidence.tet_edges[tet][k])],
                (std::array<int32_t, 2>{std::min(a, b), std::max(a, b)}));
    }
  }
}

TEST(Incidence, ListsTetsRoundNodesAndEdges) {
  const Incidence incidence = BuildIncidence(TwoTets());
  EXPECT_THAT(incidence.node_tets[0], ElementsAre(0));
  EXPECT_THAT(incidence.node_tets[2], ElementsAre(0, 1));
  EXPECT_THAT(incidence.node_tets[4], ElementsAre(1));
  EXPECT_THAT(incidence.node_edges[0], ElementsAre(0, 1, 2));
  EXPECT_THAT(incidence.edge_tets[incidence.tet_edges[1][0]], ElementsAre(0, 1));
}

TEST(Incidence, OfAnEmptyMeshIsEmpty) {
  const Incidence incidence = BuildIncidence(TetMesh{});
  EXPECT_EQ(incidence.edge_count(), 0);
  EXPECT_EQ(incidence.node_tets.rows(), 0);
}

}  // namespace
}  // namespace cleave
