#include "tests/metrics/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

class PiecesTest : public ::testing::Test {
 protected:
  const TetMesh mesh_ = KuhnBox({6, 1, 1}, {6, 1, 1});
  const Incidence incidence_ = BuildIncidence(mesh_);

  // Edges that cross the plane at `x`.
  std::vector<int32_t> Cut(double x) const {
    std::vector<int32_t> cut;
    for (size_t edge = 0; edge < incidence_.edges.size(); ++edge) {
      const auto& [a, b] = incidence_.edges[edge];
      if ((mesh_.rest_positions[static_cast<size_t>(a)][0] < x) !=
          (mesh_.rest_positions[static_cast<size_t>(b)][0] < x))
        cut.push_back(static_cast<int32_t>(edge));
    }
    return cut;
  }
  Frame At(double stretch, std::vector<int32_t> broken) const {
    Frame frame;
    frame.positions = mesh_.rest_positions;
    for (Vec3& position : frame.positions) position[0] *= stretch;
    frame.broken_edges = std::move(broken);
    return frame;
  }
  std::vector<int32_t> NodesAt(double x) const {
    std::vector<int32_t> nodes;
    for (size_t node = 0; node < mesh_.rest_positions.size(); ++node) {
      if (mesh_.rest_positions[node][0] == x) nodes.push_back(static_cast<int32_t>(node));
    }
    return nodes;
  }
};

TEST_F(PiecesTest, CracksAreTheSameWithinAReach) {
  // Middles of edges along x that a cut at 2.5 breaks lie at 2.5, those of one at 3.5 a metre on.
  const std::vector<int32_t> here = Cut(2.5), there = Cut(3.5);
  const auto same = [&](const std::vector<int32_t>& a, const std::vector<int32_t>& b,
                        double reach) { return JaccardWithin(mesh_, incidence_, a, b, reach); };
  EXPECT_EQ(same({}, {}, 0.1), 1);
  EXPECT_EQ(same(here, {}, 10), 0);
  EXPECT_EQ(same(here, here, 0), 1);
  EXPECT_EQ(same(here, there, 0.9), 0);
  EXPECT_EQ(same(here, there, 1.01), 1);
  std::vector<int32_t> both = here;
  both.insert(both.end(), there.begin(), there.end());
  const auto h = static_cast<double>(here.size()), t = static_cast<double>(there.size());
  EXPECT_DOUBLE_EQ(same(both, here, 0.1), 2 * h / (2 * h + t));
  EXPECT_EQ(same(both, here, 0.1), same(here, both, 0.1));
}

TEST_F(PiecesTest, PiecesAreWhatUnbrokenEdgesJoin) {
  const Pieces whole = PiecesOf(mesh_, incidence_, {});
  EXPECT_EQ(whole.count, 1);
  const Pieces halves = PiecesOf(mesh_, incidence_, Cut(2.5));
  ASSERT_EQ(halves.count, 2);
  EXPECT_EQ(halves.dust_count, 0);
  EXPECT_NEAR(halves.shares[0], 2.5 / 6, 1e-12);
  // Told that pieces hold half of the body, the smaller part is dust.
  const Pieces one = PiecesOf(mesh_, incidence_, Cut(2.5), 0.5);
  EXPECT_EQ(one.count, 1);
  EXPECT_EQ(one.dust_count, 1);
  EXPECT_NEAR(one.dust_share, 2.5 / 6, 1e-12);
  EXPECT_EQ(one.node_pieces.front(), -1);
  EXPECT_EQ(one.node_pieces.back(), 0);
}

TEST_F(PiecesTest, LiftIsTheSharePerShare) {
  std::vector<uint8_t> in_map(mesh_.rest_positions.size(), 0);
  for (const double x : {2.0, 3.0}) {
    for (const int32_t node : NodesAt(x)) in_map[static_cast<size_t>(node)] = 1;
  }
  const BandShare hit = ShareInBand(incidence_, Cut(2.5), in_map);
  EXPECT_EQ(hit.band, 1);
  EXPECT_GT(hit.base, 0);
  EXPECT_DOUBLE_EQ(hit.lift, 1 / hit.base);
  EXPECT_EQ(ShareInBand(incidence_, Cut(4.5), in_map).lift, 0);
  EXPECT_EQ(ShareInBand(incidence_, {}, in_map).band, 0);
  std::vector<int32_t> all(incidence_.edges.size());
  for (size_t edge = 0; edge < all.size(); ++edge) all[edge] = static_cast<int32_t>(edge);
  EXPECT_DOUBLE_EQ(ShareInBand(incidence_, all, in_map).lift, 1);
}

TEST_F(PiecesTest, FractureAndSeparationHaveTheirFrames) {
  const std::vector<int32_t> cut = Cut(2.5);
  const std::vector<int32_t> part(cut.begin(), cut.end() - 1);
  const std::vector<Frame> frames = {At(1, {}), At(1.1, {cut[0]}), At(1.2, part), At(1.3, cut)};
  EXPECT_EQ(FirstFracture(frames, incidence_.edge_count()), 1);
  EXPECT_EQ(FirstFracture(frames, 1000), 2);
  EXPECT_EQ(FirstFracture(frames, 1000000), -1);
  EXPECT_EQ(Separation(mesh_, incidence_, frames, NodesAt(0), NodesAt(6)), 3);
  EXPECT_EQ(Separation(mesh_, incidence_, frames, NodesAt(0), NodesAt(2)), -1);
  EXPECT_EQ(CrackOpenTo(frames, 0.5), 2);
  EXPECT_EQ(CrackOpenTo(frames, 1), 3);
  EXPECT_EQ(CrackOpenTo({}, 0.5), -1);
}

// By all that breaks, notches that end within the pieces had a body half torn where it was still
// whole: what then crossed the tear to come was no strands.
TEST_F(PiecesTest, ABodyHasComeApartByWhatIsBrokenBetweenItsPieces) {
  const std::vector<int32_t> cut = Cut(2.5);
  std::vector<int32_t> notches;
  for (const double x : {0.5, 1.5, 3.5, 4.5}) {
    const std::vector<int32_t> through = Cut(x);
    notches.insert(notches.end(), through.begin(), through.end() - 3);
  }
  ASSERT_GT(notches.size(), cut.size());
  const auto notched = [&](size_t torn) {
    std::vector<int32_t> edges = notches;
    edges.insert(edges.end(), cut.begin(), cut.begin() + static_cast<int64_t>(torn));
    std::sort(edges.begin(), edges.end());
    return At(1, edges);
  };
  const std::vector<Frame> frames = {At(1, {}), notched(0), notched(1), notched(cut.size())};
  ASSERT_EQ(PiecesOf(mesh_, incidence_, frames.back().broken_edges).count, 2);
  EXPECT_EQ(CrackOpenTo(frames, 0.5), 1);
  EXPECT_EQ(PartedShares(mesh_, incidence_, frames),
            (std::vector<double>{0, 0, 1.0 / static_cast<double>(cut.size()), 1}));
  const std::span<const Frame> whole(frames.data(), 3);
  EXPECT_TRUE(PartedShares(mesh_, incidence_, whole).empty());
  EXPECT_TRUE(PartedShares(mesh_, incidence_, {}).empty());
}

TEST_F(PiecesTest, StretchIsTakenBeforeAnEdgeBreaks) {
  const std::vector<int32_t> cut = Cut(2.5);
  const std::vector<Frame> frames = {At(1, {}), At(1.5, {}), At(9, cut)};
  const auto stretches = FailureStretches(mesh_, incidence_, frames);
  ASSERT_EQ(stretches.size(), cut.size());
  int along = 0;
  for (const FailureStretch& failure : stretches) {
    const auto& [a, b] = incidence_.edges[static_cast<size_t>(failure.edge)];
    const Vec3& p = mesh_.rest_positions[static_cast<size_t>(a)];
    const Vec3& q = mesh_.rest_positions[static_cast<size_t>(b)];
    if (p[1] == q[1] && p[2] == q[2]) {
      ++along;
      EXPECT_DOUBLE_EQ(failure.stretch, 1.5);
    } else {
      EXPECT_LT(failure.stretch, 1.5);
    }
  }
  EXPECT_EQ(along, 4);
}

TEST_F(PiecesTest, StrandsAreWhatStillHoldsTheTear) {
  const std::vector<int32_t> cut = Cut(2.5);
  const std::vector<int32_t> part(cut.begin(), cut.end() - 1);
  EXPECT_EQ(BridgingEdges(incidence_, At(1, part), At(1, cut)), std::vector<int32_t>{cut.back()});
  EXPECT_TRUE(BridgingEdges(incidence_, At(1, cut), At(1, cut)).empty());
  const std::vector<Frame> frames = {At(1, {}), At(1, part), At(1, cut)};
  EXPECT_DOUBLE_EQ(SmallestHold(mesh_, incidence_, frames), 1.0 / static_cast<double>(cut.size()));
  // A body that breaks at once never dangles.
  const std::vector<Frame> sudden = {At(1, {}), At(1, cut)};
  EXPECT_EQ(SmallestHold(mesh_, incidence_, sudden), 1);
}

}  // namespace
}  // namespace cleave
