#include "core/damage/edge_mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/damage/components.h"
#include "core/damage/edge_thresholds.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;

// Reference values of the method note: row b holds, for each vertex, the smallest vertex that the
// unbroken edges of mask b join it to.
constexpr int kGroups[64][4] = {
    {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0},
    {0, 0, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0},
    {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 0}, {0, 0, 0, 0},
    {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 1, 1},
    {0, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}, {0, 1, 0, 0},
    {0, 0, 2, 2}, {0, 1, 2, 2}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0},
    {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 0}, {0, 0, 0, 0},
    {0, 0, 2, 0}, {0, 0, 2, 0}, {0, 0, 0, 0}, {0, 1, 0, 1}, {0, 0, 2, 0}, {0, 1, 2, 1},
    {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 1, 0}, {0, 0, 0, 3}, {0, 0, 0, 3},
    {0, 0, 0, 3}, {0, 1, 1, 3}, {0, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 2, 0}, {0, 1, 2, 0},
    {0, 0, 0, 3}, {0, 1, 0, 3}, {0, 0, 2, 3}, {0, 1, 2, 3}};

TEST(EdgeMask, GroupsMatchTheReferenceTable) {
  for (size_t mask = 0; mask < 64; ++mask) {
    int groups = 0;
    for (size_t v = 0; v < 4; ++v) {
      EXPECT_EQ(kVertexGroups[mask].group[v], kGroups[mask][v]) << "mask " << mask;
      groups += kGroups[mask][v] == static_cast<int>(v) ? 1 : 0;
    }
    EXPECT_EQ(kVertexGroups[mask].count, groups) << "mask " << mask;
    EXPECT_EQ(Separated(static_cast<EdgeMask>(mask)), groups > 1) << "mask " << mask;
  }
}

TEST(EdgeMask, OfTetsFollowsTheBrokenEdges) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  const Incidence incidence = BuildIncidence(mesh);
  // Edge 1-2 is local edge 3 of the first tet and 0 of the second; 0-1 only in the first.
  const std::vector<int32_t> broken{incidence.tet_edges[0][0], incidence.tet_edges[0][3]};
  EXPECT_THAT(TetEdgeMasks(incidence, broken), ElementsAre(0b001001, 0b000001));
}

TEST(Components, CountFromTheSmallestNodeAndSkipNodesOfNoTet) {
  TetMesh mesh;
  mesh.rest_positions.assign(10, {0, 0, 0});
  mesh.tets = {{9, 7, 6, 5}, {4, 3, 2, 0}};
  const Incidence incidence = BuildIncidence(mesh);
  std::vector<uint8_t> broken(incidence.edges.size(), 0);
  std::vector<int32_t> labels;
  EXPECT_EQ(LabelComponents(incidence, broken, labels), 2);
  EXPECT_THAT(labels, ElementsAre(0, -1, 0, 0, 0, 1, 1, 1, -1, 1));
  broken.assign(broken.size(), 1);
  EXPECT_EQ(LabelComponents(incidence, broken, labels), 8);
  EXPECT_THAT(labels, ElementsAre(0, -1, 1, 2, 3, 4, 5, 6, -1, 7));
}

TEST(EdgeThresholds, AreTheWeakestAmongAnEdgesTets) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  const Incidence incidence = BuildIncidence(mesh);
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<double> strengths{infinite, 5.0};
  // Edges in order: 0-1 0-2 0-3 1-2 1-3 1-4 2-3 2-4 3-4.
  EXPECT_THAT(EdgeThresholds(incidence, strengths),
              ElementsAre(infinite, infinite, infinite, 5, 5, 5, 5, 5, 5));
}

// Of the largest factor among an edge's records, 1 + (R - 1) cos^2.
TEST(EdgeThresholds, AreHigherAlongADirectionOfStrength) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  const Incidence incidence = BuildIncidence(mesh);
  const std::vector<double> strengths{10.0, 5.0};
  const DirectionalStrength directional[] = {{0, {1, 0, 0}, 3}, {0, {0, 0.6, 0.8}, 2}};
  // Edges in order: 0-1 0-2 0-3 1-2 1-3 1-4 2-3 2-4 3-4. The second tet has no direction, and an
  // edge of both takes what is less.
  const std::vector<double> thresholds = EdgeThresholds(mesh, incidence, strengths, directional);
  const double expected[] = {30, 13.6, 16.4, 5, 5, 5, 5, 5, 5};
  for (size_t edge = 0; edge < 9; ++edge) EXPECT_NEAR(thresholds[edge], expected[edge], 1e-12);
  EXPECT_EQ(DirectionalStrengthFactor(1, 0.7), 1);
  EXPECT_EQ(DirectionalStrengthFactor(3, 0), 1);
  EXPECT_EQ(DirectionalStrengthFactor(3, -1), 3);
}

}  // namespace
}  // namespace cleave
