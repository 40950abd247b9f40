#include "core/damage/named_pieces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "core/base/counter_rng.h"
#include "core/damage/components.h"
#include "core/mesh/reorder.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;

// Edges of a bar along x whose ends lie on both sides of a plane.
std::vector<int32_t> CutAt(const TetMesh& mesh, const Incidence& incidence, double x) {
  std::vector<int32_t> cut;
  for (int32_t edge = 0; edge < static_cast<int32_t>(incidence.edge_count()); ++edge) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    if ((mesh.rest_positions[static_cast<size_t>(a)][0] < x) !=
        (mesh.rest_positions[static_cast<size_t>(b)][0] < x))
      cut.push_back(edge);
  }
  return cut;
}

class NamedPiecesTest : public ::testing::Test {
 protected:
  const TetMesh mesh_ = KuhnBox({8, 1, 1}, {8, 1, 1});
  const Incidence incidence_ = BuildIncidence(mesh_);
};

TEST_F(NamedPiecesTest, TheLargerPartKeepsTheIdWhereverItsNodesStand) {
  // Node 0 is at x = 0: cutting off that end moves the smallest node out of the piece.
  NamedPieces pieces(mesh_, incidence_);
  ASSERT_EQ(pieces.count(), 1);
  EXPECT_NEAR(pieces.volume(0), 8, 1e-13);
  const int32_t at_left = 0;
  int32_t at_right = 0;
  for (size_t node = 0; node < mesh_.rest_positions.size(); ++node) {
    if (mesh_.rest_positions[node][0] > 7.5) at_right = static_cast<int32_t>(node);
  }
  const auto first = pieces.Break(CutAt(mesh_, incidence_, 1.5));
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].piece, 0);
  ASSERT_EQ(first[0].parts.size(), 2u);
  EXPECT_EQ(first[0].parts[0].piece, 0);
  EXPECT_EQ(first[0].parts[1].piece, 1);
  EXPECT_NEAR(first[0].parts[0].volume, 6.5, 1e-13);
  EXPECT_NEAR(first[0].parts[1].volume, 1.5, 1e-13);
  EXPECT_EQ(first[0].parts[1].first_node, 0);
  EXPECT_GT(first[0].parts[0].first_node, 0);
  EXPECT_EQ(pieces.piece_of(at_left), 1);
  EXPECT_EQ(pieces.piece_of(at_right), 0);
  // Two cuts at once: the names go by size.
  std::vector<int32_t> two = CutAt(mesh_, incidence_, 3.5);
  const std::vector<int32_t> right = CutAt(mesh_, incidence_, 6.5);
  two.insert(two.end(), right.begin(), right.end());
  const auto second = pieces.Break(two);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_NEAR(second[0].parts[0].volume, 3, 1e-13);
  EXPECT_NEAR(second[0].parts[1].volume, 2, 1e-13);
  EXPECT_NEAR(second[0].parts[2].volume, 1.5, 1e-13);
  EXPECT_EQ(second[0].parts[1].piece, 2);
  EXPECT_EQ(pieces.piece_of(at_right), 3);
  EXPECT_TRUE(pieces.Break(two).empty());
}

TEST_F(NamedPiecesTest, OfEqualPartsTheOneWithTheSmallestNodeKeepsTheId) {
  NamedPieces halves(mesh_, incidence_);
  // x = 0..3 and 5..8 once the nodes at 4 are cut off on both sides.
  std::vector<int32_t> both = CutAt(mesh_, incidence_, 3.5);
  for (const int32_t edge : CutAt(mesh_, incidence_, 4.5)) both.push_back(edge);
  halves.Break(both);
  EXPECT_EQ(halves.piece_of(0), 0);
  EXPECT_EQ(halves.count(), 3);
  EXPECT_NEAR(halves.volume(0), 3.5, 1e-13);
  EXPECT_NEAR(halves.volume(1), 3.5, 1e-13);
  EXPECT_NEAR(halves.volume(2), 1, 1e-13);
}

// Random breaking, against components found anew, ids followed by hand.
TEST(NamedPieces, AreThoseOfTheGraphAndFollowTheRuleOnRandomBreaks) {
  const TetMesh mesh = KuhnBox({5, 4, 4}, {5, 4, 4});
  const Incidence incidence = BuildIncidence(mesh);
  for (uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    NamedPieces pieces(mesh, incidence);
    std::vector<uint8_t> broken(incidence.edges.size(), 0);
    for (uint64_t round = 0; round < 20; ++round) {
      std::vector<int32_t> before(mesh.rest_positions.size());
      for (size_t node = 0; node < before.size(); ++node)
        before[node] = pieces.piece_of(static_cast<int32_t>(node));
      const int32_t count_before = pieces.count();
      std::vector<int32_t> edges;
      for (size_t edge = 0; edge < broken.size(); ++edge) {
        if (UniformDraw(seed, RandomStream::kEdgeDraw, edge, round) < 0.1)
          edges.push_back(static_cast<int32_t>(edge));
      }
      for (const int32_t edge : edges) broken[static_cast<size_t>(edge)] = 1;
      const auto splits = pieces.Break(edges);
      std::vector<int32_t> labels;
      ASSERT_EQ(LabelComponents(incidence, broken, labels), pieces.count());
      std::map<int32_t, int32_t> piece_of_label;
      for (size_t node = 0; node < labels.size(); ++node) {
        const int32_t piece = pieces.piece_of(static_cast<int32_t>(node));
        ASSERT_EQ(piece_of_label.emplace(labels[node], piece).first->second, piece);
        // A node stays in its piece or goes to a new one.
        ASSERT_TRUE(piece == before[node] || piece >= count_before);
      }
      size_t parts = 0;
      for (const PieceSplit& split : splits) {
        parts += split.parts.size() - 1;
        for (const PiecePart& part : split.parts) {
          ASSERT_LE(part.volume, split.parts[0].volume);
          ASSERT_EQ(pieces.piece_of(part.first_node), part.piece);
        }
      }
      ASSERT_EQ(static_cast<size_t>(pieces.count() - count_before), parts);
    }
    double total = 0;
    for (int32_t piece = 0; piece < pieces.count(); ++piece) total += pieces.volume(piece);
    EXPECT_NEAR(total, 80, 1e-11);
  }
}

TEST(NamedPieces, AreTheSameInAnotherOrderOfTheMesh) {
  const TetMesh mesh = KuhnBox({5, 3, 3}, {5, 3, 3});
  const Incidence incidence = BuildIncidence(mesh);
  const MeshOrder order = LocalityOrder(mesh);
  const TetMesh reordered = Reordered(mesh, order);
  const Incidence reordered_incidence = BuildIncidence(reordered);
  std::map<std::array<int32_t, 2>, int32_t> ids;
  for (size_t edge = 0; edge < incidence.edges.size(); ++edge)
    ids[incidence.edges[edge]] = static_cast<int32_t>(edge);
  NamedPieces pieces(mesh, incidence);
  NamedPieces others(reordered, reordered_incidence, {order.old_node, order.new_node});
  for (uint64_t round = 0; round < 12; ++round) {
    std::vector<int32_t> edges;
    std::vector<int32_t> other_edges;
    for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
      const auto [a, b] = reordered_incidence.edges[edge];
      const auto [low, high] = std::minmax(order.old_node[static_cast<size_t>(a)],
                                           order.old_node[static_cast<size_t>(b)]);
      const int32_t id = ids.at({low, high});
      if (UniformDraw(1, RandomStream::kEdgeDraw, static_cast<uint64_t>(id), round) > 0.12)
        continue;
      edges.push_back(id);
      other_edges.push_back(static_cast<int32_t>(edge));
    }
    pieces.Break(edges);
    others.Break(other_edges);
    ASSERT_EQ(pieces.FirstNodes(), others.FirstNodes());
  }
  EXPECT_GT(pieces.count(), 10);
}

TEST_F(NamedPiecesTest, AStateComesBackFromItsEdgesAndFirstNodes) {
  NamedPieces pieces(mesh_, incidence_);
  std::vector<int32_t> broken = CutAt(mesh_, incidence_, 1.5);
  pieces.Break(broken);
  for (const int32_t edge : CutAt(mesh_, incidence_, 3.5)) broken.push_back(edge);
  pieces.Break(broken);
  NamedPieces other(mesh_, incidence_);
  ASSERT_TRUE(other.Reset(broken, pieces.FirstNodes()));
  for (int32_t node = 0; node < static_cast<int32_t>(mesh_.node_count()); ++node)
    ASSERT_EQ(other.piece_of(node), pieces.piece_of(node));
  const std::vector<int32_t> more = CutAt(mesh_, incidence_, 5.5);
  pieces.Break(more);
  other.Break(more);
  EXPECT_EQ(other.FirstNodes(), pieces.FirstNodes());
  // Names that do not fit are refused, and change nothing.
  const std::vector<int32_t> kept = other.FirstNodes();
  EXPECT_FALSE(other.Reset(broken, std::vector<int32_t>{0, 1, 2}));
  EXPECT_FALSE(other.Reset(broken, std::vector<int32_t>{-1, 0, 99}));
  EXPECT_EQ(other.FirstNodes(), kept);
  EXPECT_EQ(other.count(), pieces.count());
}

TEST(NamedPieces, OfAMeshInTwoBodiesAreNamedBySizeAndNodesOfNoTetHaveNone) {
  TetMesh mesh = KuhnBox({1, 1, 1}, {1, 1, 1});
  const TetMesh large = KuhnBox({2, 1, 1}, {2, 1, 1});
  const auto offset = static_cast<int32_t>(mesh.node_count());
  for (Vec3 at : large.rest_positions) mesh.rest_positions.push_back({at[0] + 9, at[1], at[2]});
  for (std::array<int32_t, 4> tet : large.tets) {
    for (int32_t& node : tet) node += offset;
    mesh.tets.push_back(tet);
  }
  mesh.rest_positions.push_back({5, 5, 5});
  const Incidence incidence = BuildIncidence(mesh);
  const NamedPieces pieces(mesh, incidence);
  EXPECT_THAT(pieces.FirstNodes(), ElementsAre(offset, 0));
  EXPECT_EQ(pieces.piece_of(static_cast<int32_t>(mesh.node_count()) - 1), -1);
}

}  // namespace
}  // namespace cleave
