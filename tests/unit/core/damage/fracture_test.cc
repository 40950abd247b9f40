#include "core/damage/fracture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <Eigen/LU>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/counter_rng.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 0.9, 0.1}, {0.1, 0.2, 1.1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

// The reference tet of the method note: deformed positions, stress (Pa) and edge stresses (Pa).
const std::vector<Vec3> kPositions = {
    {0.02, 0, 0.01}, {1.12, 0.17, -0.19}, {0.37, 0.86, 0.175}, {0.04, 0.515, 1.395}};
const std::vector<Eigen::Matrix3d> kStress = {
    (Eigen::Matrix3d() << 244.139802069357, 209.446017375931, -87.1034805881337, 161.416552223593,
     149.322679239687, 143.944906811375, -119.69978816201, 102.490810561027, 263.28686454934)
        .finished()};
constexpr std::array<double, 6> kEdgeStress = {302.203906722967, 287.407625781695,
                                               312.016928467544, 85.4783197318634,
                                               350.744179945701, 202.825829524528};

class ReferenceTet : public ::testing::Test {
 protected:
  // Thresholds at which exactly the edges of `mask` fail, all at the same ratio.
  void SetThresholds(EdgeMask mask) {
    for (size_t k = 0; k < 6; ++k)
      thresholds_[k] = (mask >> k & 1) != 0 ? kEdgeStress[k] / 1.01 : kInfinite;
  }
  EdgeFracture Fracture() const {
    return EdgeFracture(mesh_, incidence_, Broadcast<double>::PerItem(thresholds_.data()), {});
  }

  const TetMesh mesh_ = OneTet();
  const Incidence incidence_ = BuildIncidence(mesh_);
  std::array<double, 6> thresholds_{};
};

TEST_F(ReferenceTet, EdgeStressesMatch) {
  thresholds_.fill(kInfinite);
  std::vector<double> stresses(6);
  Fracture().EdgeStresses(kPositions, kStress, nullptr, stresses);
  for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(stresses[k], kEdgeStress[k], 1e-9);
}

TEST_F(ReferenceTet, KeepsTheShareOfStressOnUnbrokenEdges) {
  struct Case {
    EdgeMask mask;
    double factor;
    int64_t broken;  // orphans included
  };
  for (const Case& c : {Case{1, 0.8038498998295561, 1}, Case{3, 0.6173035536947638, 2},
                        Case{7, 0, 6}, Case{9, 0.74836887987975, 2}, Case{30, 0, 6},
                        Case{56, 0.5852158393780982, 3}, Case{63, 0, 6}}) {
    SetThresholds(c.mask);
    EdgeFracture fracture = Fracture();
    const PassResult result = fracture.BreakPass(kPositions, kStress);
    EXPECT_NEAR(result.max_ratio, 1.01, 1e-12);
    EXPECT_NEAR(fracture.damage_factors()[0], c.factor, 1e-12) << "mask " << int{c.mask};
    EXPECT_EQ(fracture.broken_edge_count(), c.broken) << "mask " << int{c.mask};
    ASSERT_EQ(result.changed_tets.size(), 1u);
    EXPECT_EQ(result.changed_tets[0].tet, 0);
    EXPECT_EQ(result.changed_tets[0].previous_factor, 1);
  }
}

TEST_F(ReferenceTet, FactorIsFrozenAndNeverRises) {
  // With an edge broken and at 0.2 already, it keeps that or nothing, whatever edges break.
  struct Case {
    EdgeMask mask;
    double factor;
  };
  for (const Case& c :
       {Case{3, 0.2}, Case{7, 0}, Case{9, 0.2}, Case{30, 0}, Case{56, 0.2}, Case{63, 0}}) {
    SCOPED_TRACE(int{c.mask});
    SetThresholds(c.mask);
    EdgeFracture fracture = Fracture();
    std::string saved;
    ByteWriter writer(saved);
    writer.PutVector(std::vector<int32_t>{std::countr_zero(c.mask)});
    writer.PutVector(std::vector<double>{0.2});
    ByteReader reader(saved);
    ASSERT_TRUE(fracture.Restore(reader).ok());
    const PassResult result = fracture.BreakPass(kPositions, kStress);
    EXPECT_FALSE(result.broken_edges.empty());
    EXPECT_EQ(result.changed_tets.size(), c.factor == 0 ? 1u : 0u);
    EXPECT_EQ(fracture.damage_factors()[0], c.factor);
    // Where no edge fails nothing moves, whatever the stress does.
    EXPECT_THAT(fracture.BreakPass(mesh_.rest_positions, kStress).broken_edges, IsEmpty());
    EXPECT_EQ(fracture.damage_factors()[0], c.factor);
  }
}

// At rest the six edge stresses N.PN make a symmetric stress: one that all but unloads the edges
// that stay.
TEST_F(ReferenceTet, DiesWhereItWouldKeepLessThanAThousandth) {
  const std::vector<Vec3>& rest = mesh_.rest_positions;
  for (const double share : {1.1e-3, 0.9e-3}) {
    SCOPED_TRACE(share);
    Eigen::Matrix<double, 6, 6> rows;
    Eigen::Matrix<double, 6, 1> wanted;
    for (Eigen::Index k = 0; k < 6; ++k) {
      const auto [a, b] = incidence_.edges[static_cast<size_t>(k)];
      const Eigen::Vector3d n = (Eigen::Vector3d(rest[static_cast<size_t>(b)].data()) -
                                 Eigen::Vector3d(rest[static_cast<size_t>(a)].data()))
                                    .normalized();
      rows.row(k) << n[0] * n[0], n[1] * n[1], n[2] * n[2], 2 * n[0] * n[1], 2 * n[1] * n[2],
          2 * n[2] * n[0];
      wanted[k] = k == 0 ? 1 : share / (5 * (1 - share));
    }
    const Eigen::Matrix<double, 6, 1> p = rows.fullPivLu().solve(wanted);
    Eigen::Matrix3d stress;
    stress << p[0], p[3], p[5], p[3], p[1], p[4], p[5], p[4], p[2];
    thresholds_.fill(kInfinite);
    thresholds_[0] = 0.99;
    EdgeFracture fracture = Fracture();
    EXPECT_FALSE(fracture.BreakPass(rest, {&stress, 1}).broken_edges.empty());
    if (share < 1e-3) {
      EXPECT_EQ(fracture.damage_factors()[0], 0);
      EXPECT_EQ(fracture.broken_edge_count(), 6);  // orphans included
    } else {
      EXPECT_NEAR(fracture.damage_factors()[0], share, 1e-9);
      EXPECT_EQ(fracture.broken_edge_count(), 1);
    }
  }
}

TEST_F(ReferenceTet, ZeroThresholdsAreCutAtOnceByTheShareOfEdges) {
  thresholds_.fill(kInfinite);
  thresholds_[3] = thresholds_[4] = 0;
  const EdgeFracture fracture = Fracture();
  EXPECT_THAT(fracture.BrokenEdges(), ElementsAre(3, 4));
  EXPECT_EQ(fracture.damage_factors()[0], 4 / 6.0);
  EXPECT_EQ(fracture.tet_masks()[0], 0b011000);
}

TEST_F(ReferenceTet, WithAllEdgesCutIsFourFreeNodes) {
  thresholds_.fill(0);
  EdgeFracture fracture = Fracture();
  EXPECT_EQ(fracture.ComponentCount(), 4);
  EXPECT_EQ(fracture.damage_factors()[0], 0);
  EXPECT_THAT(fracture.BreakPass(kPositions, kStress).broken_edges, IsEmpty());
}

TEST_F(ReferenceTet, BreaksOnlyWhatIsNearTheWorstRatio) {
  // Ratios 2, 1.9, 1.7 and below 1: 0.9 of the worst is 1.8.
  thresholds_.fill(1e4);
  thresholds_[0] = kEdgeStress[0] / 2;
  thresholds_[1] = kEdgeStress[1] / 1.9;
  thresholds_[3] = kEdgeStress[3] / 1.7;
  EdgeFracture fracture = Fracture();
  const PassResult first = fracture.BreakPass(kPositions, kStress);
  EXPECT_THAT(first.broken_edges, ElementsAre(0, 1));
  EXPECT_EQ(first.max_edge, 0);
  const PassResult second = fracture.BreakPass(kPositions, kStress);
  EXPECT_THAT(second.broken_edges, ElementsAre(3));
  const PassResult third = fracture.BreakPass(kPositions, kStress);
  EXPECT_THAT(third.broken_edges, IsEmpty());
  EXPECT_LT(third.max_ratio, 1);
}

TEST_F(ReferenceTet, AnEdgeFailsAtItsOwnThresholdWhereOthersAreLower) {
  // A stress along the edge alone is all that the tet has: its norm is the edge's stress, but for
  // rounding.
  for (uint64_t sample = 0; sample < 1000; ++sample) {
    uint64_t draw = 0;
    const auto random = [&] {
      return UniformDraw(5, RandomStream::kMeshJitter, sample, draw++) - 0.5;
    };
    std::vector<Vec3> positions = mesh_.rest_positions;
    for (Vec3& x : positions) {
      for (double& coordinate : x) coordinate += 0.2 * random();
    }
    const auto direction = [](const std::vector<Vec3>& x) {
      return (Eigen::Vector3d(x[1].data()) - Eigen::Vector3d(x[0].data())).normalized();
    };
    const std::vector<Eigen::Matrix3d> stress = {(100 + random()) * direction(positions) *
                                                 direction(mesh_.rest_positions).transpose()};
    std::vector<double> stresses(6);
    thresholds_.fill(kInfinite);
    Fracture().EdgeStresses(positions, stress, nullptr, stresses);
    thresholds_[0] = stresses[0];
    thresholds_[5] = 50;  // far from the edge, and the lowest
    EXPECT_THAT(Fracture().BreakPass(positions, stress).broken_edges, Contains(0)) << sample;
    thresholds_[0] = std::nextafter(stresses[0], kInfinite);
    const PassResult result = Fracture().BreakPass(positions, stress);
    EXPECT_THAT(result.broken_edges, Not(Contains(0))) << sample;
  }
}

TEST_F(ReferenceTet, RatiosBelowOneAreThoseOfEdgesWhoseStrengthATetsStressReached) {
  const double norm = kStress[0].norm();
  thresholds_.fill(2 * norm);
  thresholds_[2] = 0.999 * norm;
  const PassResult near = Fracture().BreakPass(kPositions, kStress);
  EXPECT_EQ(near.max_edge, 2);
  EXPECT_NEAR(near.max_ratio, kEdgeStress[2] / thresholds_[2], 1e-12);
}

TEST_F(ReferenceTet, BelowEveryThresholdReportsABound) {
  thresholds_.fill(1e4);
  const PassResult result = Fracture().BreakPass(kPositions, kStress);
  EXPECT_THAT(result.broken_edges, IsEmpty());
  EXPECT_EQ(result.max_edge, -1);
  EXPECT_NEAR(result.max_ratio, kStress[0].norm() / 1e4, 1e-15);
}

TEST_F(ReferenceTet, FailsByStrainAtTheKappaThatItWasToldOf) {
  thresholds_.fill(1e9);
  std::array<double, 6> kappa;
  kappa.fill(1);
  EdgeStrengths strengths(Broadcast<double>::PerItem(thresholds_.data()));
  strengths.kappa = Broadcast<double>::PerItem(kappa.data());
  EdgeFracture fracture(mesh_, incidence_, strengths, {});
  const std::vector<int32_t> records = {0};
  const std::vector<PlasticTet> tets = {{Eigen::Matrix3d::Identity(), 0.75}};
  const PlasticTets plastic{records, tets};
  EXPECT_THAT(fracture.BreakPass(kPositions, kStress, &plastic).broken_edges, IsEmpty());
  kappa.fill(0.5);
  fracture.UpdateThresholds();
  const PassResult result = fracture.BreakPass(kPositions, kStress, &plastic);
  EXPECT_EQ(result.broken_edges.size(), 6u);
  EXPECT_EQ(result.max_ratio, 1.5);
}

TEST_F(ReferenceTet, NanStressBreaksNothing) {
  thresholds_.fill(1);
  const std::vector<Eigen::Matrix3d> stress = {
      Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  EdgeFracture fracture = Fracture();
  fracture.BreakPass(kPositions, stress);
  EXPECT_EQ(fracture.broken_edge_count(), 0);
}

TEST(EdgeFracture, JudgesEachComponentByItsOwnWorstRatio) {
  TetMesh mesh = OneTet();
  const std::vector<Vec3> rest = mesh.rest_positions;
  mesh.rest_positions.insert(mesh.rest_positions.end(), rest.begin(), rest.end());
  mesh.tets.push_back({4, 5, 6, 7});
  const Incidence incidence = BuildIncidence(mesh);
  std::vector<Vec3> positions = kPositions;
  positions.insert(positions.end(), kPositions.begin(), kPositions.end());
  // The same stress but three times as much in the first tet: only its worst edge fails at 0.9.
  const std::vector<Eigen::Matrix3d> stress = {3 * kStress[0], kStress[0]};
  const double threshold = 349;
  EdgeFracture fracture(mesh, incidence, Broadcast<double>::Uniform(threshold), {});
  EXPECT_THAT(fracture.BreakPass(positions, stress).broken_edges, ElementsAre(4, 10));
}

// Pseudo-random stresses that grow until most of a box has failed.
class RandomStress : public ::testing::Test {
 protected:
  std::vector<Eigen::Matrix3d> Stress(uint64_t pass) const {
    std::vector<Eigen::Matrix3d> stress(mesh_.tets.size());
    for (size_t tet = 0; tet < stress.size(); ++tet) {
      for (int k = 0; k < 9; ++k)
        stress[tet](k) =
            UniformDraw(pass, RandomStream::kNodeNoise, tet, static_cast<uint64_t>(k)) *
            (1.0 + static_cast<double>(pass) / 4);
    }
    return stress;
  }
  std::string SavedAfterPasses(int threads, int passes) const {
    EdgeFracture fracture(mesh_, incidence_, Broadcast<double>::Uniform(threshold_), {});
    tbb::task_arena(threads).execute([&] {
      for (int pass = 0; pass < passes; ++pass)
        fracture.BreakPass(mesh_.rest_positions, Stress(static_cast<uint64_t>(pass)));
    });
    std::string saved;
    ByteWriter writer(saved);
    fracture.Save(writer);
    return saved;
  }

  const TetMesh mesh_ = KuhnBox({14, 10, 9}, {1.4, 1, 0.9});
  const Incidence incidence_ = BuildIncidence(mesh_);
  const double threshold_ = 2.0;
};

TEST_F(RandomStress, GivesTheSameBytesForAnyNumberOfThreads) {
  const std::string one = SavedAfterPasses(1, 12);
  EXPECT_GT(one.size(), 1000u);
  EXPECT_EQ(one, SavedAfterPasses(2, 12));
}

TEST_F(RandomStress, RestoredGoesOnAsTheOriginal) {
  const std::string halfway = SavedAfterPasses(1, 6);
  EdgeFracture fracture(mesh_, incidence_, Broadcast<double>::Uniform(threshold_), {});
  ByteReader reader(halfway);
  ASSERT_TRUE(fracture.Restore(reader).ok());
  EXPECT_EQ(reader.left(), 0u);
  for (uint64_t pass = 6; pass < 12; ++pass) fracture.BreakPass(mesh_.rest_positions, Stress(pass));
  std::string saved;
  ByteWriter writer(saved);
  fracture.Save(writer);
  EXPECT_EQ(saved, SavedAfterPasses(1, 12));
}

TEST_F(ReferenceTet, RestoreRefusesWhatCannotBeAndChangesNothing) {
  SetThresholds(9);
  EdgeFracture fracture = Fracture();
  fracture.BreakPass(kPositions, kStress);
  const auto refused = [&](const std::vector<int32_t>& edges, const std::vector<double>& factors) {
    std::string bytes;
    ByteWriter writer(bytes);
    writer.PutVector(edges);
    writer.PutVector(factors);
    ByteReader reader(bytes);
    return !fracture.Restore(reader).ok();
  };
  EXPECT_TRUE(refused({6}, {0.5}));
  EXPECT_TRUE(refused({-1}, {0.5}));
  EXPECT_TRUE(refused({1, 1}, {0.5}));
  EXPECT_TRUE(refused({2, 1}, {0.5}));
  EXPECT_TRUE(refused({1}, {}));
  EXPECT_TRUE(refused({1}, {0.5, 0.5}));
  EXPECT_TRUE(refused({1}, {1.5}));
  EXPECT_TRUE(refused({1}, {std::nan("")}));
  EXPECT_TRUE(refused({0, 1, 2}, {0.5})) << "a separated tet is dead";
  std::string bytes;
  ByteWriter writer(bytes);
  fracture.Save(writer);
  ByteReader truncated(absl::string_view(bytes).substr(0, bytes.size() - 1));
  EXPECT_FALSE(fracture.Restore(truncated).ok());
  EXPECT_THAT(fracture.BrokenEdges(), ElementsAre(0, 3));
  EXPECT_NEAR(fracture.damage_factors()[0], 0.74836887987975, 1e-12);
}

}  // namespace
}  // namespace cleave
