#include "core/damage/random_graph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

RandomGraphSettings Settings(ImpurityEffect effect) {
  RandomGraphSettings settings;
  settings.effect = effect;
  return settings;
}
const RandomGraphSettings kDegradation = Settings(ImpurityEffect::kDegradation);
const RandomGraphSettings kUpgradation = Settings(ImpurityEffect::kUpgradation);

// The method note's reference table: k = 5, a0 = 0.2, omega = 1. Probabilities p that a bond fails,
// and strengths, 1 - p over that of a pure bond.
struct Row {
  double potency_i, potency_j, share_i, share_j;
  double degradation_p, degradation, upgradation_p, upgradation;
};
constexpr Row kReference[] = {
    {0, 0, 1, 1, 0.00149205766767346, 1.0, 0.900332005375044, 1.0},
    {0, 0, 0.5, 1, 0.00271703990085792, 0.998773187291507, 0.95004162504212, 0.501247919614216},
    {0, 0, 0.5, 0.5, 0.00470463114195629, 0.996782626018198, 0.975005207031579, 0.250780534538439},
    {0, 0, 0.07142857142857142, 0.07142857142857142, 0.0116023405129301, 0.989874609488192,
     0.999489795962637, 0.00511903584779065},
    {0, 0.1, 1, 1, 0.0109725977989008, 0.990505293218717, 0.89044152978557, 1.09923421883515},
    {0, 0.1, 0.5, 1, 0.0168738163576184, 0.984595256544464, 0.945055391310813, 0.551276354018563},
    {0, 0.1, 0.5, 0.5, 0.0290667747670156, 0.972384078353015, 0.97000899676118, 0.30090906666352},
    {0, 0.1, 0.07142857142857142, 0.07142857142857142, 0.0613351705035394, 0.940067464364796,
     0.998775510816071, 0.0122856809604378},
    {0.1, 0.1, 1, 1, 0.0457059618596501, 0.955720027535583, 0.879587082383613, 1.20814026678767},
    {0.1, 0.1, 0.5, 1, 0.0696333094383242, 0.931756925626965, 0.93409566531621, 0.661238694846664},
    {0.1, 0.1, 0.5, 0.5, 0.100528577362969, 0.900815491297981, 0.96401554394207, 0.361043243554132},
    {0.1, 0.1, 0.07142857142857142, 0.07142857142857142, 0.17920783394969, 0.822018665302846,
     0.997061232949915, 0.029485564158718},
    {0.3, 0.3, 1, 1, 0.283702129800976, 0.717368224959621, 0.832590765263215, 1.67966893852671},
    {0.3, 0.3, 0.5, 1, 0.364851047612713, 0.636098047356237, 0.89637333953366, 1.03971852605524},
    {0.3, 0.3, 0.5, 0.5, 0.445400277650618, 0.555428453632469, 0.936087238404718,
     0.641256622407035},
    {0.3, 0.3, 0.07142857142857142, 0.07142857142857142, 0.595446469921606, 0.405158049252401,
     0.986204956812949, 0.138409960378568},
    {0, 1, 1, 1, 0.19950097823937, 0.801695197226789, 0.802624679775096, 1.98032799764473},
    {0, 1, 0.5, 1, 0.234928209581902, 0.766215027424854, 0.900332005375044, 1.0},
    {0, 1, 0.5, 0.5, 0.374899585991482, 0.626034493574884, 0.925140309312501, 0.751090567931975},
    {0, 1, 0.07142857142857142, 0.07142857142857142, 0.57085880610393, 0.429782454102145,
     0.992347088183607, 0.0767840453215728},
    {1, 1, 1, 1, 0.67599885357845, 0.32448529719728, 0.620051037744775, 3.8121461526837},
    {1, 1, 0.5, 1, 0.760310703897482, 0.240047460756946, 0.708687387548409, 2.92283007747654},
    {1, 1, 0.5, 0.5, 0.824071729541234, 0.176191157826777, 0.778721532101556, 2.22015571529356},
    {1, 1, 0.07142857142857142, 0.07142857142857142, 0.918322946427034, 0.0817991025511365,
     0.885705701778311, 1.14675025470083},
    {0, 3, 1, 1, 0.343009539950802, 0.65797219250414, 0.620051037744775, 3.8121461526837},
    {0, 3, 0.5, 1, 0.381930622386534, 0.618992950791931, 0.802624679775096, 1.98032799764473},
    {0, 3, 0.5, 0.5, 0.58067313141237, 0.419953463372721, 0.82676484216534, 1.73812223760027},
    {0, 3, 0.07142857142857142, 0.07142857142857142, 0.807717106223091, 0.192570219649702,
     0.978064743595355, 0.220083252273572},
    {3, 3, 1, 1, 0.829418407777192, 0.170836490117807, 0.0783314455935287, 9.24738736717489},
    {3, 3, 0.5, 1, 0.893761791536771, 0.106396958861516, 0.114648351797738, 8.88300854786718},
    {3, 3, 0.5, 0.5, 0.934080108197564, 0.0660183950549848, 0.158877098367957, 8.43924777253856},
    {3, 3, 0.07142857142857142, 0.07142857142857142, 0.985260952644395, 0.0147610717258565,
     0.263234452106848, 7.39219797353758},
    {1, 3, 1, 1, 0.763913998819485, 0.236438781477354, 0.335963229732151, 6.66248751935439},
    {1, 3, 0.5, 1, 0.82676484216534, 0.173494020918868, 0.462950433001965, 5.38838539913357},
    {1, 3, 0.5, 0.5, 0.892088490560786, 0.108072760229782, 0.518450201635692, 4.83153895266327},
    {1, 3, 0.07142857142857142, 0.07142857142857142, 0.965277569878293, 0.0347743154056463,
     0.682304658262762, 3.18753620891746},
    {10, 10, 1, 1, 0.880011843469573, 0.120167453300529, 6.18164408550115e-11, 10.0333111316338},
    {10, 10, 0.5, 1, 0.934427175320142, 0.0656708093144378, 1.85706672262143e-10, 10.0333111303907},
    {10, 10, 0.5, 0.5, 0.964250151390988, 0.0358032691512773, 5.30684829413985e-10,
     10.0333111269295},
    {10, 10, 0.07142857142857142, 0.07142857142857142, 0.997128074808915, 0.00287621667222497,
     3.09466086090282e-09, 10.0333111012043},
    {1000000.0, 1000000.0, 1, 1, 0.900331807361731, 0.0998171255458052, 0.0, 10.033311132254},
    {1000000.0, 1000000.0, 0.5, 1, 0.950041475416427, 0.0500331769689073, 0.0, 10.033311132254},
    {1000000.0, 1000000.0, 0.5, 0.5, 0.975005107093974, 0.0250322424553209, 0.0, 10.033311132254},
    {1000000.0, 1000000.0, 0.07142857142857142, 0.07142857142857142, 0.99948978167683,
     0.00051098073589529, 0.0, 10.033311132254},
};
constexpr double kPureDegradationP = 0.0014920576676734632;
constexpr double kPureUpgradationP = 0.9003320053750442;

TEST(BondStrength, MatchesTheReferenceTable) {
  const BondStrength weaker(kDegradation), stronger(kUpgradation);
  for (const Row& row : kReference) {
    EXPECT_NEAR(weaker(row.potency_i, row.potency_j, row.share_i, row.share_j), row.degradation,
                1e-12);
    EXPECT_NEAR(stronger(row.potency_i, row.potency_j, row.share_i, row.share_j), row.upgradation,
                1e-11);
  }
}

// Of p the strengths keep the ratios; what a bond of infinite potency holds with, tanh(1 / (2 k))
// or surely, tells the rest.
TEST(BondStrength, FollowsTheFailureProbabilitiesOfTheReferenceTable) {
  const BondStrength weaker(kDegradation), stronger(kUpgradation);
  const double pure_weaker = std::tanh(0.1) / weaker.extreme();
  const double pure_stronger = 1 / stronger.extreme();
  EXPECT_NEAR(1 - pure_weaker, kPureDegradationP, 1e-14);
  EXPECT_NEAR(1 - pure_stronger, kPureUpgradationP, 1e-14);
  for (const Row& row : kReference) {
    EXPECT_NEAR(1 - pure_weaker * weaker(row.potency_i, row.potency_j, row.share_i, row.share_j),
                row.degradation_p, 1e-13);
    EXPECT_NEAR(
        1 - pure_stronger * stronger(row.potency_i, row.potency_j, row.share_i, row.share_j),
        row.upgradation_p, 1e-13);
  }
}

TEST(BondStrength, IsMonotoneInPotencyAndBonds) {
  const BondStrength weaker(kDegradation), stronger(kUpgradation);
  const double sizes[] = {0, 1e-300, 0.01, 0.1, 1, 10, 1e6, 1e300};
  for (size_t k = 1; k < std::size(sizes); ++k) {
    for (const double share : {0.1, 0.5, 1.0}) {
      EXPECT_LE(weaker(sizes[k], 0.5, share, 1), weaker(sizes[k - 1], 0.5, share, 1));
      EXPECT_GE(stronger(sizes[k], 0.5, share, 1), stronger(sizes[k - 1], 0.5, share, 1));
    }
    EXPECT_EQ(weaker(sizes[k], 0.5, 1, 1), weaker(-sizes[k], 0.5, 1, 1));
  }
  for (const double potency : {0.0, 0.3, 3.0}) {
    EXPECT_LT(weaker(potency, potency, 0.5, 1), weaker(potency, potency, 1, 1));
    EXPECT_LT(stronger(potency, potency, 0.5, 1), stronger(potency, potency, 1, 1));
  }
}

TEST(BondStrength, SpansADecadeEachWay) {
  const BondStrength weaker(kDegradation), stronger(kUpgradation);
  EXPECT_NEAR(weaker(1e300, 1e300, 1, 1), weaker.extreme(), 1e-5);
  EXPECT_NEAR(weaker.extreme(), 0.0998, 1e-4);
  EXPECT_NEAR(stronger(1e300, 1e300, 1, 1), stronger.extreme(), 1e-12);
  EXPECT_NEAR(stronger.extreme(), 10.03, 0.01);
}

class Graph : public ::testing::Test {
 protected:
  RandomGraph Make(const RandomGraphSettings& settings, const std::vector<double>& draws = {},
                   const std::vector<int32_t>& deal = {}) {
    return RandomGraph(incidence_, settings, potencies_, draws, deal);
  }
  static std::vector<double> Copy(std::span<const double> values) {
    return {values.begin(), values.end()};
  }

  const TetMesh mesh_ = KuhnBox({4, 3, 3}, {4, 3, 3});
  const Incidence incidence_ = BuildIncidence(mesh_);
  std::vector<double> potencies_ = std::vector<double>(static_cast<size_t>(mesh_.node_count()), 0);
};

TEST_F(Graph, ThePureBodyKeepsItsStrength) {
  for (const RandomGraphSettings& settings : {kDegradation, kUpgradation}) {
    const RandomGraph graph = Make(settings);
    for (const double factor : graph.factors()) EXPECT_NEAR(factor, 1, 1e-12);
  }
}

TEST_F(Graph, ANodesPotencyChangesItsOwnEdgesOnly) {
  const std::vector<double> before = Copy(Make(kDegradation).factors());
  constexpr int32_t kNode = 37;
  potencies_[kNode] = 2;
  const std::vector<double> after = Copy(Make(kDegradation).factors());
  for (size_t edge = 0; edge < before.size(); ++edge) {
    const auto [a, b] = incidence_.edges[edge];
    if (a == kNode || b == kNode) {
      EXPECT_LT(after[edge], before[edge]);
    } else {
      EXPECT_EQ(after[edge], before[edge]);
    }
  }
}

TEST_F(Graph, LostBondsWeakenTheOthersAndAStartFromThemGivesTheSame) {
  for (double& potency : potencies_) potency = 0.5;
  RandomGraph graph = Make(kDegradation);
  const std::vector<double> before = Copy(graph.factors());
  const int32_t broken[] = {20, 60};
  const auto changed = graph.Break(broken);
  std::vector<uint8_t> fell(before.size(), 0);
  for (const int32_t edge : changed) fell[static_cast<size_t>(edge)] = 1;
  for (size_t edge = 0; edge < before.size(); ++edge) {
    if (fell[edge] != 0) {
      EXPECT_LT(graph.factors()[edge], before[edge]);
    } else {
      EXPECT_EQ(graph.factors()[edge], before[edge]);
    }
  }
  const std::vector<double> weakened = Copy(graph.factors());
  std::vector<uint8_t> mask(before.size(), 0);
  graph.Reset(mask);
  EXPECT_EQ(Copy(graph.factors()), before);
  for (const int32_t edge : broken) mask[static_cast<size_t>(edge)] = 1;
  graph.Reset(mask);
  EXPECT_EQ(Copy(graph.factors()), weakened);
}

TEST_F(Graph, WithoutDegreesNothingFalls) {
  RandomGraphSettings settings = kDegradation;
  settings.follows_degrees = false;
  RandomGraph graph = Make(settings);
  const std::vector<double> before = Copy(graph.factors());
  const int32_t broken[] = {20, 60};
  EXPECT_TRUE(graph.Break(broken).empty());
  EXPECT_EQ(Copy(graph.factors()), before);
}

// A draw for every edge, spread evenly over (0, 1).
std::vector<double> EvenDraws(size_t edges) {
  std::vector<double> draws(edges);
  for (size_t edge = 0; edge < edges; ++edge)
    draws[edge] = (static_cast<double>(edge * 7919 % edges) + 0.5) / static_cast<double>(edges);
  return draws;
}

TEST_F(Graph, DrawnStrengthsAreFullOrExtremeInTheirShares) {
  for (double& potency : potencies_) potency = 0.5;
  const std::vector<double> draws = EvenDraws(incidence_.edges.size());
  for (RandomGraphSettings settings : {kDegradation, kUpgradation}) {
    settings.follows_degrees = false;
    const BondStrength bond(settings);
    const double kappa = bond(0.5, 0.5, 1, 1);
    const RandomGraph graph = Make(settings, draws);
    size_t extreme = 0;
    double sum = 0;
    for (const double factor : graph.factors()) {
      const bool is_extreme = factor == bond.extreme();
      EXPECT_TRUE(is_extreme || factor == 1);
      extreme += is_extreme ? 1 : 0;
      sum += factor;
    }
    const double share = settings.effect == ImpurityEffect::kUpgradation
                             ? (kappa - 1) / (bond.extreme() - 1)
                             : 1 - kappa;
    const auto edges = static_cast<double>(draws.size());
    EXPECT_NEAR(static_cast<double>(extreme) / edges, share, 1 / edges);
    // Strengthened, they are on average what is expected; weakened, all but the little that weak
    // edges keep.
    if (settings.effect == ImpurityEffect::kUpgradation) {
      EXPECT_NEAR(sum / edges, kappa, 10 / edges);
    }
  }
}

// One draw an edge for good: what is weak stays so however many bonds are lost, and none mends.
TEST_F(Graph, DrawnStrengthsOnlyFallAsBondsAreLost) {
  for (double& potency : potencies_) potency = 0.3;
  const std::vector<double> draws = EvenDraws(incidence_.edges.size());
  for (const RandomGraphSettings& settings : {kDegradation, kUpgradation}) {
    RandomGraph graph = Make(settings, draws);
    std::vector<double> before = Copy(graph.factors());
    int fallen = 0;
    for (int32_t edge = 0; edge < 60; edge += 3) {
      const int32_t broken[] = {edge};
      graph.Break(broken);
      for (size_t k = 0; k < before.size(); ++k) {
        EXPECT_LE(graph.factors()[k], before[k]);
        fallen += graph.factors()[k] < before[k] ? 1 : 0;
      }
      before = Copy(graph.factors());
    }
    EXPECT_GT(fallen, 0);
  }
}

TEST_F(Graph, DealtStrengthsAreThoseOfOtherEdges) {
  for (size_t node = 0; node < potencies_.size(); ++node)
    potencies_[node] = static_cast<double>(node) / 30;
  RandomGraphSettings settings = kDegradation;
  settings.follows_degrees = false;
  std::vector<int32_t> deal(incidence_.edges.size());
  std::iota(deal.rbegin(), deal.rend(), 0);
  const std::vector<double> own = Copy(Make(settings).factors());
  const RandomGraph graph = Make(settings, {}, deal);
  for (size_t edge = 0; edge < own.size(); ++edge)
    EXPECT_EQ(graph.factors()[edge], own[own.size() - 1 - edge]);
}

}  // namespace
}  // namespace cleave
