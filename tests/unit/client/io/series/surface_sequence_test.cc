#include "client/io/series/surface_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "tests/unit/client/io/two_tets.h"

namespace cleave {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;

Frame AtRest(const TetMesh& mesh) {
  Frame frame;
  frame.positions = mesh.rest_positions;
  return frame;
}

// Every edge at node 4.
std::vector<int32_t> EdgesAtTip(const TetMesh& mesh) {
  const Incidence incidence = BuildIncidence(mesh);
  const auto edges = incidence.node_edges[4];
  return {edges.begin(), edges.end()};
}

TEST(SurfaceSequence, AWholeBodyIsOnePieceWithItsRegions) {
  const TetMesh mesh = TwoTets();
  SurfaceSequence sequence(mesh, {});
  ASSERT_TRUE(sequence.Advance(AtRest(mesh)).ok());
  const ShownSurface& surface = sequence.surface();
  EXPECT_TRUE(CheckShownSurface(surface).ok());
  EXPECT_EQ(surface.triangles.size(), 6u);
  EXPECT_THAT(surface.pieces, Each(0));
  EXPECT_THAT(surface.inside, Each(0));
  EXPECT_EQ(std::set<int32_t>(surface.regions.begin(), surface.regions.end()),
            (std::set<int32_t>{5, 6}));
  EXPECT_TRUE(surface.strains.empty());
  EXPECT_TRUE(surface.velocities.empty());
}

TEST(SurfaceSequence, ABreakOpensInsideFacesAndThePiecesKeepTheirIds) {
  const TetMesh mesh = TwoTets();
  SurfaceSequence sequence(mesh, {});
  Frame frame = AtRest(mesh);
  ASSERT_TRUE(sequence.Advance(frame).ok());
  frame.time = 0.1;
  frame.broken_edges = EdgesAtTip(mesh);
  ASSERT_TRUE(sequence.Advance(frame).ok());
  EXPECT_EQ(sequence.piece_count(), 2);
  EXPECT_THAT(sequence.node_pieces(), ElementsAre(0, 0, 0, 0, 1));
  EXPECT_THAT(sequence.surface().inside, ::testing::Contains(1));
  EXPECT_THAT(sequence.surface().pieces, ::testing::Contains(1));
  EXPECT_EQ(sequence.surface().broken_edges, 3);
  EXPECT_TRUE(CheckShownSurface(sequence.surface()).ok());
}

TEST(SurfaceSequence, WhereItsPointsAreIsTheSameWithVelocitiesAndWithout) {
  const TetMesh mesh = TwoTets();
  SurfaceSequence without(mesh, {}), with(mesh, {.velocities = true});
  Frame frame = AtRest(mesh);
  for (int turns = 0; turns < 3; ++turns) {
    SCOPED_TRACE(turns);
    // A quarter turn a frame, in the second of which the tip loses the one tet that it had.
    if (turns > 0) {
      for (Vec3& position : frame.positions) position = {position[0], -position[2], position[1]};
      frame.time += 0.1;
      frame.broken_edges = EdgesAtTip(mesh);
    }
    ASSERT_TRUE(without.Advance(frame).ok());
    ASSERT_TRUE(with.Advance(frame).ok());
    EXPECT_EQ(with.surface().points, without.surface().points);
  }
}

TEST(SurfaceSequence, APieceKeepsItsIdInItsLargerPart) {
  // Node 0 comes off: the rest of the body stays piece 0 although its smallest node is another.
  const TetMesh mesh = TwoTets();
  SurfaceSequence sequence(mesh, {});
  Frame frame = AtRest(mesh);
  ASSERT_TRUE(sequence.Advance(frame).ok());
  const Incidence incidence = BuildIncidence(mesh);
  frame.broken_edges.assign(incidence.node_edges[0].begin(), incidence.node_edges[0].end());
  ASSERT_TRUE(sequence.Advance(frame).ok());
  EXPECT_THAT(sequence.node_pieces(), ElementsAre(1, 0, 0, 0, 0));
  for (const int32_t edge : EdgesAtTip(mesh)) frame.broken_edges.push_back(edge);
  std::sort(frame.broken_edges.begin(), frame.broken_edges.end());
  ASSERT_TRUE(sequence.Advance(frame).ok());
  EXPECT_THAT(sequence.node_pieces(), ElementsAre(1, 0, 0, 0, 2));
  // Of an earlier frame, as of another epoch, the surface is that of its edges.
  frame.broken_edges.clear();
  ASSERT_TRUE(sequence.Advance(frame).ok());
  EXPECT_EQ(sequence.piece_count(), 1);
  EXPECT_THAT(sequence.surface().inside, Each(0));
}

TEST(SurfaceSequence, TellsTheFaceBehindOuterTrianglesWhereAsked) {
  const TetMesh mesh = TwoTets();
  Frame frame = AtRest(mesh);
  frame.broken_edges = EdgesAtTip(mesh);
  SurfaceSequence plain(mesh, {});
  ASSERT_TRUE(plain.Advance(frame).ok());
  EXPECT_TRUE(plain.surface().sources.empty());
  EXPECT_TRUE(plain.surface().uvs.empty());
  SurfaceSequence full(mesh, {.sources = true});
  ASSERT_TRUE(full.Advance(frame).ok());
  const ShownSurface& surface = full.surface();
  ASSERT_TRUE(CheckShownSurface(surface).ok());
  std::set<int64_t> sources;
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    EXPECT_EQ(surface.sources[i] < 0, surface.inside[i] != 0);
    if (surface.sources[i] >= 0) sources.insert(surface.sources[i]);
  }
  EXPECT_EQ(sources.size(), 6u);  // faces of the body
}

TEST(SurfaceSequence, ARenderMeshStandsForTheSurfaceAndBreaksWithThePieces) {
  const TetMesh mesh = TwoTets();
  RenderMesh render;  // the body's own six faces
  render.points = mesh.rest_positions;
  render.triangles = {{3, 2, 0}, {1, 3, 0}, {2, 1, 0}, {2, 3, 4}, {3, 1, 4}, {1, 2, 4}};
  render.uvs.assign(6, CornerUvs{{{0, 0}, {1, 0}, {0, 1}}});
  ASSERT_EQ(CountOpenEdges(render.triangles), 0);
  SurfaceSequence sequence(mesh, {.velocities = true, .sources = true, .render_mesh = &render});
  Frame frame = AtRest(mesh);
  ASSERT_TRUE(sequence.Advance(frame).ok());
  EXPECT_THAT(sequence.surface().inside, Each(0));
  EXPECT_EQ(sequence.embedded()->gaps(), 0);
  frame.time = 1;
  frame.broken_edges = EdgesAtTip(mesh);
  frame.positions[4][2] += 2;
  ASSERT_TRUE(sequence.Advance(frame).ok());
  const ShownSurface& surface = sequence.surface();
  ASSERT_TRUE(CheckShownSurface(surface).ok());
  EXPECT_EQ(CountOpenEdges(surface.triangles), 0);
  EXPECT_THAT(surface.inside, ::testing::Contains(1));
  EXPECT_EQ(surface.uvs.size(), surface.triangles.size());
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const int32_t point : surface.triangles[i]) {
      const auto p = static_cast<size_t>(point);
      EXPECT_EQ(surface.points[p][2] > 1.2, surface.pieces[i] == 1);
      EXPECT_NEAR(surface.velocities[p][2], surface.pieces[i] == 1 ? 2 : 0, 1e-9);
    }
  }
}

TEST(SurfaceSequence, FramesPassedByNamePiecesAsFramesShownDo) {
  const TetMesh mesh = TwoTets();
  const Incidence incidence = BuildIncidence(mesh);
  Frame tip = AtRest(mesh);
  tip.time = 0.1;
  tip.broken_edges = EdgesAtTip(mesh);
  Frame both = tip;
  both.time = 0.2;
  for (const int32_t edge : incidence.node_edges[0]) both.broken_edges.push_back(edge);
  std::sort(both.broken_edges.begin(), both.broken_edges.end());
  SurfaceSequence shown(mesh, {});
  ASSERT_TRUE(shown.Advance(tip).ok());
  ASSERT_TRUE(shown.Advance(both).ok());
  EXPECT_THAT(shown.node_pieces(), ElementsAre(2, 0, 0, 0, 1));
  SurfaceSequence sought(mesh, {});
  ASSERT_TRUE(sought.PassBy(AtRest(mesh)).ok());
  ASSERT_TRUE(sought.PassBy(tip).ok());
  EXPECT_FALSE(sought.PassBy(AtRest(mesh)).ok());  // back in time
  ASSERT_TRUE(sought.Advance(both).ok());
  EXPECT_TRUE(sought.changed());
  EXPECT_THAT(sought.node_pieces(), ElementsAre(2, 0, 0, 0, 1));
  EXPECT_EQ(sought.topology().point_ids, shown.topology().point_ids);
  EXPECT_EQ(sought.surface().points, shown.surface().points);
  both.time = 0.3;
  ASSERT_TRUE(sought.Advance(both).ok());
  EXPECT_FALSE(sought.changed());
  // Passed by last: what is shown next is of all that broke.
  SurfaceSequence late(mesh, {});
  ASSERT_TRUE(late.Advance(tip).ok());
  ASSERT_TRUE(late.PassBy(both).ok());
  both.time = 0.4;
  ASSERT_TRUE(late.Advance(both).ok());
  EXPECT_EQ(late.piece_count(), 3);
  EXPECT_EQ(late.surface().triangles.size(), shown.surface().triangles.size());
}

TEST(SurfaceSequence, VelocityAndDisplacementFollowARigidMotionAlsoWhereEdgesBreak) {
  const TetMesh mesh = TwoTets();
  SurfaceSequence sequence(mesh, {.displacements = true, .velocities = true});
  Frame frame = AtRest(mesh);
  ASSERT_TRUE(sequence.Advance(frame).ok());
  EXPECT_THAT(sequence.surface().velocities, Each(Vec3{0, 0, 0}));
  frame.time = 0.5;
  for (Vec3& position : frame.positions) position[0] += 1;
  frame.broken_edges = EdgesAtTip(mesh);
  ASSERT_TRUE(sequence.Advance(frame).ok());
  for (const Vec3& velocity : sequence.surface().velocities) EXPECT_NEAR(velocity[0], 2, 1e-12);
  for (const Vec3& moved : sequence.surface().displacements) EXPECT_NEAR(moved[0], 1, 1e-12);
}

TEST(SurfaceSequence, StrainIsTheLargestPrincipalStretchLessOne) {
  const TetMesh mesh = TwoTets();
  SurfaceSequence sequence(mesh, {.strains = true});
  Frame frame = AtRest(mesh);
  // Stretched by 1.25 along y, squeezed along x, and turned by a quarter about z.
  for (Vec3& p : frame.positions) p = {-1.25 * p[1], 0.9 * p[0], p[2]};
  ASSERT_TRUE(sequence.Advance(frame).ok());
  EXPECT_THAT(sequence.surface().strains, Each(FloatNear(0.25f, 1e-5f)));
}

TEST(SurfaceSequence, AFrameOfAnotherMeshIsRefusedAndChangesNothing) {
  const TetMesh mesh = TwoTets();
  SurfaceSequence sequence(mesh, {});
  ASSERT_TRUE(sequence.Advance(AtRest(mesh)).ok());
  Frame frame = AtRest(mesh);
  frame.time = -1;
  frame.positions.pop_back();
  frame.positions[2][1] = std::numeric_limits<double>::infinity();
  frame.broken_edges = {3, 2};
  const absl::Status status = sequence.Advance(frame);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  for (const char* field : {"time", "positions", "positions[2]", "broken_edges[1]"}) {
    EXPECT_THAT(std::string(status.message()), HasSubstr(field));
  }
  frame = AtRest(mesh);
  frame.broken_edges = {9};
  EXPECT_FALSE(sequence.Advance(frame).ok());
  EXPECT_EQ(sequence.surface().broken_edges, 0);
}

}  // namespace
}  // namespace cleave
