#include "core/surface/fragments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

TEST(Fragments, OfABarCutInTwoHaveTheirNodesShareOfTheVolume) {
  TetMesh mesh = KuhnBox({3, 1, 1}, {3, 1, 1});
  mesh.rest_positions.push_back({9, 9, 9});  // a node of no tet
  const Incidence incidence = BuildIncidence(mesh);
  std::vector<int32_t> cut;
  for (int32_t edge = 0; edge < static_cast<int32_t>(incidence.edge_count()); ++edge) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    if ((mesh.rest_positions[static_cast<size_t>(a)][0] < 0.5) !=
        (mesh.rest_positions[static_cast<size_t>(b)][0] < 0.5))
      cut.push_back(edge);
  }
  const Fragments fragments = FindFragments(mesh, incidence, cut);
  EXPECT_EQ(fragments.count(), 2);
  EXPECT_THAT(fragments.volumes, ElementsAre(DoubleNear(0.5, 1e-14), DoubleNear(2.5, 1e-14)));
  EXPECT_THAT(fragments.node_counts, ElementsAre(4, 12));
  EXPECT_EQ(fragments.node_fragments.front(), 0);
  EXPECT_EQ(fragments.node_fragments[15], 1);
  EXPECT_EQ(fragments.node_fragments.back(), -1);
}

TEST(Fragments, AreDustBelowAShare) {
  EXPECT_EQ(CountPieces(std::vector<double>{6, 3, 0.5, 0.5}, 0.1), 2);
  EXPECT_EQ(CountPieces(std::vector<double>{6, 3, 0.5, 0.5}, 0), 4);
  EXPECT_EQ(CountPieces(std::vector<double>{}, 0.1), 0);
}

}  // namespace
}  // namespace cleave
