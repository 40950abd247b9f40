#include "client/io/bake/baked_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "core/surface/faces.h"
#include "core/surface/visible_surface.h"
#include "tests/unit/client/io/bake/breaking_bar.h"

namespace cleave {
namespace {

using ::cleave::testing::BarFrame;
using ::cleave::testing::BarMesh;
using ::cleave::testing::PiecesOfBar;
using ::testing::HasSubstr;

// Of the space that a closed surface encloses.
double Volume(const std::vector<Vec3>& points,
              const std::vector<std::array<int32_t, 3>>& triangles) {
  double six = 0;
  for (const auto& triangle : triangles) {
    const Vec3& a = points[static_cast<size_t>(triangle[0])];
    const Vec3& b = points[static_cast<size_t>(triangle[1])];
    const Vec3& c = points[static_cast<size_t>(triangle[2])];
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

class BakedSurfaceTest : public ::testing::Test {
 protected:
  const TetMesh mesh_ = BarMesh();
  const Incidence incidence_ = BuildIncidence(mesh_);
  const Frame last_ = BarFrame(mesh_, 5);
  const BakedSurface surface_ = BakeSurface(mesh_, incidence_, PiecesOfBar(mesh_, incidence_, 6),
                                            last_.broken_edges, nullptr);
  BakedMotion motion_{mesh_, incidence_, surface_, last_.broken_edges};
};

TEST_F(BakedSurfaceTest, PiecesAreThoseOfTheLastFrameTheLargerFirst) {
  ASSERT_EQ(surface_.pieces.size(), 2u);
  EXPECT_GT(surface_.pieces[0].volume, surface_.pieces[1].volume);
  EXPECT_NEAR(surface_.pieces[0].volume + surface_.pieces[1].volume, 2 * 1 * 1, 1e-12);
  EXPECT_EQ(surface_.pieces[0].nodes + surface_.pieces[1].nodes, 45);
  EXPECT_EQ(surface_.pieces[1].smallest_node, 0);
  EXPECT_LT(surface_.pieces[1].center[0], 0.75);
  EXPECT_NEAR(surface_.pieces[1].center[1], 0.5, 0.05);  // the tets are not symmetric
  EXPECT_EQ(std::set<int32_t>(surface_.point_pieces.begin(), surface_.point_pieces.end()),
            (std::set<int32_t>{0, 1}));
  EXPECT_EQ(std::set<int32_t>(surface_.triangle_regions.begin(), surface_.triangle_regions.end()),
            (std::set<int32_t>{3, 7}));
}

TEST_F(BakedSurfaceTest, SidesOfACrackCoincideToTheBitUntilItOpens) {
  // Copies of a point have equal rest positions and nodes.
  std::map<std::pair<std::array<int32_t, 4>, Vec3>, std::vector<size_t>> copies;
  const auto& points = surface_.topology.points;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!points[i].owned_by_all()) copies[{points[i].nodes, points[i].rest}].push_back(i);
  }
  ASSERT_GT(copies.size(), 20u);
  for (const int64_t position : {0, 1, 2, 3, 4, 5}) {
    ASSERT_TRUE(motion_.Advance(BarFrame(mesh_, position)).ok());
    size_t open = 0;
    for (const auto& [place, ids] : copies) {
      for (const size_t id : ids) {
        open += motion_.points()[id] != motion_.points()[ids[0]] ? 1 : 0;
      }
    }
    if (position < 2) {
      EXPECT_EQ(open, 0u) << position;
    }
    if (position == 3) {  // cracked from below
      EXPECT_GT(open, 0u);
      EXPECT_LT(open, copies.size());
    }
    if (position >= 4) {
      EXPECT_GE(open, copies.size()) << position;
    }
  }
}

TEST_F(BakedSurfaceTest, EnclosesWhatTheSurfaceOfEachFrameDoes) {
  const Faces faces = BuildFaces(mesh_);
  PointMotion own_motion(mesh_, incidence_);
  for (const int64_t position : {0, 1, 2, 4, 5}) {
    const Frame frame = BarFrame(mesh_, position);
    ASSERT_TRUE(motion_.Advance(frame).ok());
    // Half a crack has its points in faces elsewhere than a whole one.
    const SurfaceTopology own =
        ExtractSurface(mesh_, incidence_, faces, frame.broken_edges, SurfaceOptions{});
    std::vector<Vec3> own_points;
    own_motion.Move(own, frame.positions, own_points);
    const double expected = Volume(own_points, own.triangles);
    const double tolerance = position == 2 ? 1e-3 * expected : 1e-12;
    EXPECT_NEAR(Volume(motion_.points(), surface_.topology.triangles), expected, tolerance)
        << position;
  }
}

TEST_F(BakedSurfaceTest, PointsOfWholeTetsLieOnThem) {
  ASSERT_TRUE(motion_.Advance(BarFrame(mesh_, 1)).ok());
  const Frame frame = BarFrame(mesh_, 1);
  for (size_t i = 0; i < surface_.topology.points.size(); ++i) {
    const SurfacePoint& point = surface_.topology.points[i];
    Vec3 mean{0, 0, 0};
    for (size_t k = 0; k < point.node_count; ++k) {
      for (size_t axis = 0; axis < 3; ++axis) {
        mean[axis] += point.weights[k] * frame.positions[static_cast<size_t>(point.nodes[k])][axis];
      }
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(motion_.points()[i][axis], mean[axis], 1e-15);
    }
  }
}

TEST_F(BakedSurfaceTest, VelocitiesAreThoseOfTheSideAlsoInTheFrameOfTheBreak) {
  for (const int64_t position : {0, 1, 2, 3}) {
    ASSERT_TRUE(motion_.Advance(BarFrame(mesh_, position)).ok());
  }
  ASSERT_TRUE(motion_.Advance(BarFrame(mesh_, 4)).ok());
  for (size_t i = 0; i < surface_.topology.points.size(); ++i) {
    if (surface_.topology.points[i].rest[0] < 1.25) continue;  // away from the crack
    const double expected = 0.2 * surface_.topology.points[i].rest[0] + 2;
    EXPECT_NEAR(motion_.velocities()[i][0], expected, 1e-9);
  }
}

TEST_F(BakedSurfaceTest, ARenderMeshIsSplitOnceAndOpensWhereTheBodyCracks) {
  const Faces faces = BuildFaces(mesh_);
  const SurfaceTopology own = ExtractSurface(mesh_, incidence_, faces, {}, SurfaceOptions{});
  RenderMesh render;
  for (const SurfacePoint& point : own.points) render.points.push_back(point.rest);
  render.triangles = own.triangles;
  for (const auto& triangle : own.triangles) {
    CornerUvs uvs{};
    for (size_t k = 0; k < 3; ++k)
      uvs[k][0] = static_cast<float>(7 * render.points[static_cast<size_t>(triangle[k])][0]);
    render.uvs.push_back(uvs);
  }
  const BakedSurface baked = BakeSurface(mesh_, incidence_, PiecesOfBar(mesh_, incidence_, 6),
                                         last_.broken_edges, &render);
  EXPECT_EQ(baked.gaps, 0);
  EXPECT_EQ(CountOpenEdges(baked.topology.triangles), 0);
  EXPECT_EQ(std::set<int32_t>(baked.point_pieces.begin(), baked.point_pieces.end()),
            (std::set<int32_t>{0, 1}));
  // Texture is the render mesh's outside, and that of the rest shape inside.
  for (size_t i = 0; i < baked.topology.triangles.size(); ++i) {
    const auto point = static_cast<size_t>(baked.topology.triangles[i][0]);
    const double x = baked.topology.points[point].rest[0];
    if (baked.topology.inside[i] == 0) {
      EXPECT_NEAR(baked.UvAt(i, 0)[0], 7 * x, 1e-5);
    } else {
      EXPECT_LE(baked.UvAt(i, 0)[0], 2);
    }
  }
  BakedMotion motion(mesh_, incidence_, baked, last_.broken_edges);
  std::map<Vec3, std::vector<size_t>> copies;
  for (size_t i = 0; i < baked.topology.points.size(); ++i)
    copies[baked.topology.points[i].rest].push_back(i);
  for (const int64_t position : {0, 1, 3, 5}) {
    ASSERT_TRUE(motion.Advance(BarFrame(mesh_, position)).ok());
    size_t open = 0;
    size_t pairs = 0;
    for (const auto& [place, ids] : copies) {
      for (size_t k = 1; k < ids.size(); ++k) {
        // Points of other kinds may lie there too.
        if (baked.point_pieces[ids[k]] == baked.point_pieces[ids[0]]) continue;
        ++pairs;
        open += motion.points()[ids[k]] != motion.points()[ids[0]] ? 1 : 0;
      }
    }
    ASSERT_GT(pairs, 20u);
    if (position < 2) {
      EXPECT_EQ(open, 0u) << position;
    }
    if (position == 3) {  // cracked from below, and in one piece
      EXPECT_GT(open, 0u);
      EXPECT_LT(open, pairs);
    }
    if (position == 5) {
      EXPECT_EQ(open, pairs);
    }
  }
}

TEST_F(BakedSurfaceTest, FramesOfOtherMeshesAndEdgesThatHealAreRefused) {
  Frame frame = BarFrame(mesh_, 0);
  frame.positions.pop_back();
  EXPECT_THAT(std::string(motion_.Advance(frame).message()), HasSubstr("44 nodes, the mesh 45"));
  frame = BarFrame(mesh_, 0);
  for (int32_t edge = 0; edge < incidence_.edge_count(); ++edge) frame.broken_edges.push_back(edge);
  EXPECT_THAT(std::string(motion_.Advance(frame).message()),
              HasSubstr("broken_edges: frame 10 has one that is whole in the last frame"));
  ASSERT_TRUE(motion_.Advance(BarFrame(mesh_, 1)).ok());
  EXPECT_THAT(std::string(motion_.Advance(BarFrame(mesh_, 0)).message()), HasSubstr("is before"));
}

}  // namespace
}  // namespace cleave
