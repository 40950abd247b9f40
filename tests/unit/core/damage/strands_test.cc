// Strands: what the rules of fracture leave of torn tets that have a law for it.

#include "core/damage/strands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "core/base/counter_rng.h"
#include "core/damage/fracture.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kResidual = 0.1;
constexpr double kLimit = 1.5;

using Edge = std::array<int32_t, 2>;

// Edges of these meshes break under tension all round where they are weak, and never elsewhere.
struct TornMesh {
  TornMesh(TetMesh tets, const std::vector<Edge>& weak, std::vector<StrandLaw> strand_laws,
           std::vector<int16_t> laws_of_tets = {}, double weak_threshold = 1)
      : mesh(std::move(tets)),
        incidence(BuildIncidence(mesh)),
        laws(std::move(strand_laws)),
        tet_laws(std::move(laws_of_tets)),
        thresholds(ThresholdsFor(incidence, weak, weak_threshold)),
        stress(mesh.tets.size(), 2 * Eigen::Matrix3d::Identity()),
        fracture(mesh, incidence, Broadcast<double>::PerItem(thresholds.data()), {},
                 {laws, tet_laws}) {}

  static std::vector<double> ThresholdsFor(const Incidence& incidence,
                                           const std::vector<Edge>& weak, double threshold) {
    std::vector<double> thresholds;
    for (const Edge& edge : incidence.edges) {
      const bool is_weak = std::find(weak.begin(), weak.end(), edge) != weak.end();
      thresholds.push_back(is_weak ? threshold : kInfinite);
    }
    return thresholds;
  }
  PassResult Break() { return fracture.BreakPass(mesh.rest_positions, stress); }
  PassResult BreakStretched(double stretch) {
    std::vector<Vec3> positions = mesh.rest_positions;
    for (Vec3& p : positions) p[0] *= stretch;
    return fracture.BreakPass(positions, stress);
  }
  double Factor(size_t tet) const { return fracture.damage_factors()[tet]; }

  TetMesh mesh;
  Incidence incidence;
  std::vector<StrandLaw> laws;
  std::vector<int16_t> tet_laws;
  std::vector<double> thresholds;
  std::vector<Eigen::Matrix3d> stress;
  EdgeFracture fracture;
};

TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}
const std::vector<Edge> kAllButTwo = {{0, 2}, {0, 3}, {1, 2}, {1, 3}};

TEST(Strands, ATornTetHoldsItsUnbrokenEdgesUntilOneIsTooLong) {
  TornMesh torn(OneTet(), kAllButTwo, {{kResidual, kLimit}});
  torn.Break();
  EXPECT_EQ(torn.Factor(0), kResidual);
  EXPECT_TRUE(torn.fracture.IsStrand(0));
  EXPECT_EQ(torn.fracture.broken_edge_count(), 4);
  EXPECT_EQ(torn.fracture.ComponentCount(), 2);  // nodes 0 and 1, nodes 2 and 3

  EXPECT_THAT(torn.BreakStretched(kLimit).changed_tets, IsEmpty());
  const int64_t damage = torn.fracture.damage_count();
  const PassResult result = torn.BreakStretched(1.001 * kLimit);
  ASSERT_EQ(result.changed_tets.size(), 1u);
  EXPECT_EQ(result.changed_tets[0].previous_factor, kResidual);
  EXPECT_EQ(result.broken_edges.size(), 2u);  // no live tet is left at them
  EXPECT_EQ(torn.Factor(0), 0);
  EXPECT_FALSE(torn.fracture.IsStrand(0));
  EXPECT_EQ(torn.fracture.damage_count(), damage + 3);
  torn.Break();
  EXPECT_EQ(torn.Factor(0), 0);
}

TEST(Strands, BrokenEdgesMayBeOfAnyLength) {
  TornMesh torn(OneTet(), {{0, 1}, {1, 2}, {1, 3}}, {{kResidual, kLimit}});
  torn.Break();
  std::vector<Vec3> positions = torn.mesh.rest_positions;
  positions[1] = {5, 0, 0};
  EXPECT_THAT(torn.fracture.BreakPass(positions, torn.stress).changed_tets, IsEmpty());
  EXPECT_EQ(torn.Factor(0), kResidual);
}

TEST(Strands, WithNoEdgeLeftOrNoLawATetDies) {
  std::vector<Edge> all = kAllButTwo;
  all.push_back({0, 1});
  all.push_back({2, 3});
  TornMesh gone(OneTet(), all, {{kResidual, kLimit}});
  gone.Break();
  EXPECT_EQ(gone.Factor(0), 0);
  TornMesh other(OneTet(), kAllButTwo, {{kResidual, kLimit}}, {-1});
  other.Break();
  EXPECT_EQ(other.Factor(0), 0);
  EXPECT_EQ(other.fracture.broken_edge_count(), 6);
}

TEST(Strands, EdgesCutBeforeTheFirstStepLeaveNone) {
  TornMesh cut(OneTet(), kAllButTwo, {{kResidual, kLimit}}, {}, 0);
  EXPECT_EQ(cut.Factor(0), 0);
  EXPECT_EQ(cut.fracture.broken_edge_count(), 6);
}

TEST(Strands, DamageThatTearsNothingLeavesAtLeastTheResidualFactor) {
  // Four of six edges broken, all vertices joined: 2/6 of the stress or so is left.
  for (const double residual : {0.1, 0.9}) {
    TornMesh torn(OneTet(), {{0, 1}, {0, 2}, {1, 2}}, {{residual, kLimit}});
    TornMesh without(OneTet(), {{0, 1}, {0, 2}, {1, 2}}, {});
    torn.Break();
    without.Break();
    ASSERT_GT(without.Factor(0), 0.1);
    ASSERT_LT(without.Factor(0), 0.9);
    EXPECT_EQ(torn.Factor(0), std::max(residual, without.Factor(0)));
    EXPECT_FALSE(torn.fracture.IsStrand(0));
  }
}

// Two tets that share the face 1-2-3.
TetMesh TwoTets() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  return mesh;
}

TEST(Strands, StressBreaksNoneOfTheirEdges) {
  TornMesh torn(TwoTets(), {{0, 1}, {0, 2}, {0, 3}}, {{kResidual, 100}});
  torn.Break();
  ASSERT_TRUE(torn.fracture.IsStrand(0));
  ASSERT_EQ(torn.Factor(1), 1);
  std::fill(torn.thresholds.begin(), torn.thresholds.end(), 1.0);
  torn.fracture.UpdateThresholds();
  torn.stress = {1e6 * Eigen::Matrix3d::Identity(), 0.9 * Eigen::Matrix3d::Identity()};
  const PassResult calm = torn.Break();
  EXPECT_THAT(calm.broken_edges, IsEmpty());
  EXPECT_LT(calm.max_ratio, 2);
  // Of the solid tet only the edges that it shares with no strand.
  torn.stress[1] = 1.1 * Eigen::Matrix3d::Identity();
  const PassResult result = torn.Break();
  ASSERT_EQ(result.broken_edges.size(), 3u);
  for (const int32_t edge : result.broken_edges)
    EXPECT_EQ(torn.incidence.edges[static_cast<size_t>(edge)][1], 4);
  EXPECT_TRUE(torn.fracture.IsStrand(1));
  EXPECT_EQ(torn.fracture.ComponentCount(), 3);
}

TEST(Strands, HangByNodes) {
  // Three tets in a row: the last shares an edge with the middle one alone.
  TetMesh mesh = TwoTets();
  mesh.rest_positions.push_back({1, 0, 1.25});
  mesh.rest_positions.push_back({0, 1, 1.25});
  mesh.tets.push_back({3, 4, 6, 5});
  const std::vector<Edge> middle = {{1, 4}, {2, 4}, {3, 4}};
  TornMesh without(mesh, middle, {});
  without.Break();
  EXPECT_THAT(without.fracture.damage_factors(), ElementsAre(1, 0, 0));
  // With strands the middle tet holds the face to nothing, and the small one hangs on by node 3.
  TornMesh with(mesh, middle, {{kResidual, kLimit}});
  with.Break();
  EXPECT_THAT(with.fracture.damage_factors(), ElementsAre(1, kResidual, kResidual));
  EXPECT_TRUE(with.fracture.IsStrand(2));
  EXPECT_EQ(with.fracture.broken_edge_count(), 3);
  EXPECT_EQ(with.fracture.ComponentCount(), 1);
  with.BreakStretched(2);
  EXPECT_THAT(with.fracture.damage_factors(), ElementsAre(1, 0, 0));
}

std::string Saved(const EdgeFracture& fracture) {
  std::string bytes;
  ByteWriter out(bytes);
  fracture.Save(out);
  return bytes;
}

// What holds after every pass, checked the slow way, and that saved states are the same states.
TEST(Strands, KeepTheirPromisesInABoxThatFallsApart) {
  const TetMesh mesh = KuhnBox({5, 4, 3}, {1.5, 1, 0.7});
  int64_t strands = 0;
  for (uint64_t seed = 0; seed < 3; ++seed) {
    TornMesh torn(mesh, {}, {{kResidual, kLimit}});
    std::fill(torn.thresholds.begin(), torn.thresholds.end(), 1.0);
    torn.fracture.UpdateThresholds();
    std::vector<double> factors(mesh.tets.size(), 1.0);
    std::vector<uint8_t> was_strand(mesh.tets.size(), 0);
    int64_t damage = 0;
    for (uint64_t pass = 0; pass < 40; ++pass) {
      for (size_t tet = 0; tet < torn.stress.size(); ++tet) {
        for (int k = 0; k < 9; ++k)
          torn.stress[tet](k) = 2 * UniformDraw(seed, RandomStream::kEdgeDraw, tet,
                                                9 * pass + static_cast<uint64_t>(k)) -
                                0.5;
      }
      std::vector<Vec3> positions = mesh.rest_positions;
      for (size_t node = 0; node < positions.size(); ++node) {
        for (size_t axis = 0; axis < 3; ++axis)
          positions[node][axis] *= 1 + 0.025 * static_cast<double>(pass) *
                                           UniformDraw(seed, RandomStream::kEdgeDeal, node, axis);
      }
      const PassResult result = torn.fracture.BreakPass(positions, torn.stress);
      const bool changed = !result.broken_edges.empty() || !result.changed_tets.empty();
      ASSERT_EQ(torn.fracture.damage_count() > damage, changed);
      damage = torn.fracture.damage_count();
      for (size_t tet = 0; tet < factors.size(); ++tet) {
        const auto id = static_cast<int32_t>(tet);
        ASSERT_LE(torn.Factor(tet), factors[tet]);
        factors[tet] = torn.Factor(tet);
        const bool is_strand = torn.fracture.IsStrand(id);
        ASSERT_TRUE(!is_strand || factors[tet] <= kResidual);
        ASSERT_TRUE(factors[tet] == 0 || factors[tet] >= kResidual);
        ASSERT_TRUE(was_strand[tet] == 0 || is_strand || factors[tet] == 0);
        was_strand[tet] = is_strand ? 1 : 0;
        strands += is_strand ? 1 : 0;
        ASSERT_TRUE(!Separated(torn.fracture.tet_masks()[tet]) || is_strand || factors[tet] == 0);
      }
      for (int32_t edge = 0; edge < static_cast<int32_t>(torn.incidence.edge_count()); ++edge) {
        const auto tets = torn.incidence.edge_tets[edge];
        const bool live = std::any_of(tets.begin(), tets.end(), [&](int32_t tet) {
          return torn.Factor(static_cast<size_t>(tet)) > 0;
        });
        ASSERT_TRUE(live || torn.fracture.edge_broken()[static_cast<size_t>(edge)] != 0);
      }
      const std::string saved = Saved(torn.fracture);
      TornMesh again(mesh, {}, {{kResidual, kLimit}});
      ByteReader in(saved);
      ASSERT_TRUE(again.fracture.Restore(in).ok());
      ASSERT_EQ(Saved(again.fracture), saved);
      ASSERT_EQ(again.fracture.damage_count(), torn.fracture.damage_count());
    }
  }
  EXPECT_GT(strands, 100);
}

TEST(Strands, AStateThatCannotBeIsRefused) {
  TornMesh torn(TwoTets(), {{0, 1}, {0, 2}, {0, 3}}, {{kResidual, kLimit}}, {0, -1});
  torn.Break();
  const std::string good = Saved(torn.fracture);
  const auto refused = [&](const std::vector<int32_t>& strands, const std::vector<double>& left) {
    std::string bytes;
    ByteWriter out(bytes);
    out.PutVector(torn.fracture.BrokenEdges());
    out.PutVector(strands);
    out.PutVector(left);
    ByteReader in(bytes);
    const absl::Status status = torn.fracture.Restore(in);
    return !status.ok() && Saved(torn.fracture) == good;
  };
  EXPECT_FALSE(refused({0}, {kResidual}));
  EXPECT_TRUE(refused({}, {kResidual}));        // torn, live and no strand
  EXPECT_TRUE(refused({0}, {0}));               // a dead strand
  EXPECT_TRUE(refused({2}, {kResidual}));       // no such tet
  EXPECT_TRUE(refused({1}, {kResidual, 0.5}));  // a tet without a law
  EXPECT_TRUE(refused({0, 0}, {kResidual}));
}

}  // namespace
}  // namespace cleave
