// Separation, orphans and hinges (method note, section 3), by hand on a few tets and as invariants
// of a box that falls apart at random.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/base/counter_rng.h"
#include "core/damage/components.h"
#include "core/damage/fracture.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

using NodePairs = std::vector<std::array<int32_t, 2>>;

// A mesh with some edges cut from the start and all others unbreakable.
struct CutMesh {
  CutMesh(TetMesh tets, const NodePairs& cuts)
      : mesh(std::move(tets)),
        incidence(BuildIncidence(mesh)),
        thresholds(ThresholdsFor(incidence, cuts)),
        fracture(mesh, incidence, Broadcast<double>::PerItem(thresholds.data()), {}) {}

  static std::vector<double> ThresholdsFor(const Incidence& incidence, const NodePairs& cuts) {
    std::vector<double> thresholds;
    for (const std::array<int32_t, 2>& edge : incidence.edges) {
      const bool cut = std::find(cuts.begin(), cuts.end(), edge) != cuts.end();
      thresholds.push_back(cut ? 0 : kInfinite);
    }
    return thresholds;
  }
  NodePairs Broken() const {
    NodePairs pairs;
    for (const int32_t edge : fracture.BrokenEdges())
      pairs.push_back(incidence.edges[static_cast<size_t>(edge)]);
    return pairs;
  }

  TetMesh mesh;
  Incidence incidence;
  std::vector<double> thresholds;
  EdgeFracture fracture;
};

TetMesh TwoTets() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  return mesh;
}

TEST(Separation, KillsATetWhoseVertexIsCutOff) {
  CutMesh cut(TwoTets(), {{0, 1}, {0, 2}, {0, 3}});
  EXPECT_THAT(cut.fracture.damage_factors(), ElementsAre(0, 1));
  EXPECT_THAT(cut.Broken(), ElementsAre(NodePairs::value_type{0, 1}, NodePairs::value_type{0, 2},
                                        NodePairs::value_type{0, 3}));
  EXPECT_EQ(cut.fracture.ComponentCount(), 2);
}

TEST(Orphans, EdgesOfDeadTetsBreak) {
  // The cut separates only the first tet's node 0; the second loses node 4 the same way, so the
  // edges of the face between them have no live tet left.
  CutMesh cut(TwoTets(), {{0, 1}, {0, 2}, {0, 3}, {1, 4}, {2, 4}, {3, 4}});
  EXPECT_THAT(cut.fracture.damage_factors(), ElementsAre(0, 0));
  EXPECT_EQ(cut.fracture.broken_edge_count(), 9);
  EXPECT_EQ(cut.fracture.ComponentCount(), 5);
}

TEST(Orphans, AnEdgeWithOneLiveTetStays) {
  CutMesh cut(TwoTets(), {{1, 4}, {2, 4}, {3, 4}, {1, 2}});
  EXPECT_THAT(cut.fracture.damage_factors(), ElementsAre(5 / 6.0, 0));
  EXPECT_EQ(cut.fracture.broken_edge_count(), 4);
  EXPECT_EQ(cut.fracture.ComponentCount(), 2);
}

// Three tets in a row: the middle one shares the face 1-2-3 with the first and the edge 3-4 with
// the last. Without it, first and last meet in node 3 only.
TetMesh HingedTets(double last_height) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0},
                         {1, 0, 0},
                         {0, 1, 0},
                         {0, 0, 1},
                         {1, 1, 1},
                         {1, 0, 1 + last_height},
                         {0, 1, 1 + last_height}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}, {3, 4, 6, 5}};
  return mesh;
}

double Volume(const TetMesh& mesh, size_t tet) {
  std::array<Vec3, 3> d{};
  for (size_t k = 0; k < 3; ++k) {
    for (size_t axis = 0; axis < 3; ++axis) {
      d[k][axis] = mesh.rest_positions[static_cast<size_t>(mesh.tets[tet][k + 1])][axis] -
                   mesh.rest_positions[static_cast<size_t>(mesh.tets[tet][0])][axis];
    }
  }
  return (d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
          d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
          d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0])) /
         6;
}

const NodePairs kCutMiddle = {{1, 4}, {2, 4}, {3, 4}};

TEST(Hinges, TheSmallerClusterDies) {
  // Last larger than first: the first, held only at node 3, dies, and with it its edges.
  CutMesh last_larger(HingedTets(2), kCutMiddle);
  ASSERT_GT(Volume(last_larger.mesh, 2), Volume(last_larger.mesh, 0));
  EXPECT_THAT(last_larger.fracture.damage_factors(), ElementsAre(0, 0, 5 / 6.0));
  EXPECT_EQ(last_larger.fracture.ComponentCount(), 4);  // the last tet, and nodes 0, 1, 2

  // Last smaller than first: it dies, down to the edge that no live tet is left at.
  CutMesh last_smaller(HingedTets(0.25), kCutMiddle);
  ASSERT_LT(Volume(last_smaller.mesh, 2), Volume(last_smaller.mesh, 0));
  EXPECT_THAT(last_smaller.fracture.damage_factors(), ElementsAre(1, 0, 0));
  EXPECT_EQ(last_smaller.fracture.ComponentCount(), 4);  // the first tet, and nodes 4, 5, 6
}

TEST(Hinges, OfEqualClustersTheLowestTetLives) {
  const TetMesh mesh = HingedTets(0.5);
  ASSERT_EQ(Volume(mesh, 0), Volume(mesh, 2));
  CutMesh cut(mesh, kCutMiddle);
  EXPECT_THAT(cut.fracture.damage_factors(), ElementsAre(1, 0, 0));
}

TEST(Hinges, WithAnEdgeInCommonBothLive) {
  CutMesh cut(HingedTets(2), {{1, 4}, {2, 4}});
  EXPECT_THAT(cut.fracture.damage_factors(), ElementsAre(1, 4 / 6.0, 1));
  EXPECT_EQ(cut.fracture.ComponentCount(), 1);
}

// What the rules promise after every pass, checked the slow way.
void CheckInvariants(const TetMesh& mesh, const Incidence& incidence, EdgeFracture& fracture) {
  const auto live = [&](int32_t tet) {
    return fracture.damage_factors()[static_cast<size_t>(tet)] > 0;
  };
  const auto broken = [&](int32_t edge) {
    return fracture.edge_broken()[static_cast<size_t>(edge)] != 0;
  };
  const std::vector<EdgeMask> masks = TetEdgeMasks(incidence, fracture.BrokenEdges());
  for (int32_t tet = 0; tet < static_cast<int32_t>(mesh.tet_count()); ++tet) {
    ASSERT_EQ(masks[static_cast<size_t>(tet)], fracture.tet_masks()[static_cast<size_t>(tet)]);
    ASSERT_FALSE(Separated(masks[static_cast<size_t>(tet)]) && live(tet)) << tet;
  }
  for (int32_t edge = 0; edge < static_cast<int32_t>(incidence.edge_count()); ++edge) {
    const auto tets = incidence.edge_tets[edge];
    ASSERT_TRUE(broken(edge) || std::any_of(tets.begin(), tets.end(), live)) << edge;
  }
  // Live tets of a node hang together through unbroken edges at it.
  for (int32_t node = 0; node < static_cast<int32_t>(mesh.node_count()); ++node) {
    std::vector<int32_t> waiting;
    for (const int32_t tet : incidence.node_tets[node])
      if (live(tet)) waiting.push_back(tet);
    if (waiting.empty()) continue;
    std::vector<int32_t> reached{waiting.front()};
    waiting.erase(waiting.begin());
    for (size_t i = 0; i < reached.size(); ++i) {
      for (const int32_t edge : incidence.tet_edges[static_cast<size_t>(reached[i])]) {
        const auto& ends = incidence.edges[static_cast<size_t>(edge)];
        if (broken(edge) || (ends[0] != node && ends[1] != node)) continue;
        for (const int32_t tet : incidence.edge_tets[edge]) {
          const auto found = std::find(waiting.begin(), waiting.end(), tet);
          if (found == waiting.end()) continue;
          reached.push_back(tet);
          waiting.erase(found);
        }
      }
    }
    ASSERT_TRUE(waiting.empty()) << "node " << node << " is a hinge";
  }
  // Mechanical pieces, joined by live tets, are the graph's components.
  std::vector<int32_t> piece(static_cast<size_t>(mesh.node_count()));
  std::iota(piece.begin(), piece.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (int32_t tet = 0; tet < static_cast<int32_t>(mesh.tet_count()); ++tet) {
      if (!live(tet)) continue;
      const auto& nodes = mesh.tets[static_cast<size_t>(tet)];
      int32_t lowest = piece[static_cast<size_t>(nodes[0])];
      for (const int32_t node : nodes) lowest = std::min(lowest, piece[static_cast<size_t>(node)]);
      for (const int32_t node : nodes) {
        changed |= piece[static_cast<size_t>(node)] != lowest;
        piece[static_cast<size_t>(node)] = lowest;
      }
    }
  }
  int32_t pieces = 0;
  for (size_t node = 0; node < piece.size(); ++node)
    pieces += piece[node] == static_cast<int32_t>(node) ? 1 : 0;
  ASSERT_EQ(fracture.ComponentCount(), pieces);
}

TEST(Rules, HoldAfterEveryPassOfABoxThatFallsApart) {
  const TetMesh mesh = KuhnBox({5, 4, 3}, {1.5, 1, 0.7});
  const Incidence incidence = BuildIncidence(mesh);
  for (uint64_t seed = 0; seed < 5; ++seed) {
    const double threshold = 1;
    EdgeFracture fracture(mesh, incidence, Broadcast<double>::Uniform(threshold),
                          {.simultaneity = seed % 2 == 0 ? 0.9 : 0.5});
    std::vector<double> factors(mesh.tets.size(), 1.0);
    int breaking_passes = 0;
    for (uint64_t pass = 0; pass < 60; ++pass) {
      std::vector<Eigen::Matrix3d> stress(mesh.tets.size());
      for (size_t tet = 0; tet < stress.size(); ++tet) {
        for (int k = 0; k < 9; ++k)
          stress[tet](k) = 2 * UniformDraw(seed, RandomStream::kEdgeDraw, tet,
                                           9 * pass + static_cast<uint64_t>(k)) -
                           0.5;
      }
      const PassResult result = fracture.BreakPass(mesh.rest_positions, stress);
      breaking_passes += result.broken_edges.empty() ? 0 : 1;
      ASSERT_TRUE(std::is_sorted(result.broken_edges.begin(), result.broken_edges.end()));
      size_t changed = 0;
      for (size_t tet = 0; tet < factors.size(); ++tet) {
        const double now = fracture.damage_factors()[tet];
        ASSERT_LE(now, factors[tet]);
        if (now == factors[tet]) continue;
        ASSERT_LT(changed, result.changed_tets.size());
        ASSERT_EQ(result.changed_tets[changed].tet, static_cast<int32_t>(tet));
        ASSERT_EQ(result.changed_tets[changed].previous_factor, factors[tet]);
        factors[tet] = now;
        ++changed;
      }
      ASSERT_EQ(changed, result.changed_tets.size());
      ASSERT_NO_FATAL_FAILURE(CheckInvariants(mesh, incidence, fracture));
    }
    EXPECT_GT(breaking_passes, 10);
    EXPECT_GT(fracture.ComponentCount(), 5);
  }
}

}  // namespace
}  // namespace cleave
