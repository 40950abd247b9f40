#include "core/surface/embedded_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "core/surface/fans.h"
#include "core/surface/point_motion.h"
#include "core/surface/shared_edges.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/surface/fine_box.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double VolumeOf(const std::vector<std::array<int32_t, 3>>& triangles,
                const std::vector<Vec3>& points) {
  double volume = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vector3d p(points[static_cast<size_t>(a)].data());
    const Vector3d q(points[static_cast<size_t>(b)].data());
    const Vector3d r(points[static_cast<size_t>(c)].data());
    volume += p.dot(q.cross(r)) / 6;
  }
  return volume;
}

class EmbeddedMeshTest : public ::testing::Test {
 protected:
  // Edges between nodes that are nearest to different ones of some random places.
  std::vector<int32_t> Shatter(uint64_t seed, uint64_t count) const {
    std::vector<uint64_t> nearest;
    for (const Vec3& at : box_.mesh.rest_positions) {
      uint64_t best = 0;
      double least = 1e9;
      for (uint64_t k = 0; k < count; ++k) {
        double distance = 0;
        for (size_t axis = 0; axis < 3; ++axis) {
          const double place = kSize[axis] * UniformDraw(seed, RandomStream::kMeshJitter, k, axis);
          distance += (at[axis] - place) * (at[axis] - place);
        }
        if (distance < least) best = k;
        least = std::min(least, distance);
      }
      nearest.push_back(best);
    }
    std::vector<int32_t> edges;
    for (int32_t edge = 0; edge < static_cast<int32_t>(box_.incidence.edge_count()); ++edge) {
      const auto [a, b] = box_.incidence.edges[static_cast<size_t>(edge)];
      if (nearest[static_cast<size_t>(a)] != nearest[static_cast<size_t>(b)]) edges.push_back(edge);
    }
    return edges;
  }

  // Closed pieces that share no points and add up to the render mesh.
  void ExpectSound(const EmbeddedMesh& embedded, const NamedPieces& pieces) {
    const SurfaceTopology& surface = embedded.topology();
    EXPECT_EQ(CountOpenEdges(surface.triangles), 0);
    ASSERT_EQ(surface.triangles.size(), embedded.uvs().size());
    std::map<int32_t, int32_t> piece_of_point;
    for (size_t i = 0; i < surface.triangles.size(); ++i) {
      const int32_t piece = pieces.piece_of(surface.nodes[i]);
      for (const int32_t point : surface.triangles[i]) {
        ASSERT_EQ(piece_of_point.emplace(point, piece).first->second, piece);
        ASSERT_NE(surface.points[static_cast<size_t>(point)].owners, 0);
      }
      ASSERT_EQ(surface.inside[i] != 0, embedded.sources()[i] < 0);
    }
    ASSERT_EQ(piece_of_point.size(), surface.points.size());
    using Ids = std::set<SurfaceId>;
    ASSERT_EQ(Ids(surface.point_ids.begin(), surface.point_ids.end()).size(),
              surface.points.size());
    ASSERT_EQ(Ids(surface.triangle_ids.begin(), surface.triangle_ids.end()).size(),
              surface.triangles.size());
    std::vector<Vec3> points;
    for (const SurfacePoint& point : surface.points) points.push_back(point.rest);
    const double whole = VolumeOf(embedded.divided().triangles, embedded.divided().points);
    EXPECT_NEAR(VolumeOf(surface.triangles, points), whole, 1e-12 * whole);
    ASSERT_NO_FATAL_FAILURE(ExpectManifoldWhereParted(embedded, whole));
  }

  // The same where sheets that only touch are parted, as exports and pictures have it.
  static void ExpectManifoldWhereParted(const EmbeddedMesh& embedded, double volume) {
    SurfaceTopology parted = embedded.topology();
    std::vector<CornerUvs> uvs = embedded.uvs();
    std::vector<int32_t> sources = embedded.sources();
    SeparateSharedEdges(parted, uvs, sources);
    SeparateFans(parted);
    ASSERT_NO_FATAL_FAILURE(ExpectManifold(parted));
    ASSERT_EQ(uvs.size(), parted.triangles.size());
    ASSERT_EQ(sources.size(), parted.triangles.size());
    EXPECT_NEAR(VolumeOf(parted.triangles, RestPoints(parted)), volume, 1e-12 * volume);
  }

  void ExpectSoundWithout(const std::vector<int32_t>& broken, const RenderMesh& render) {
    EmbeddedMesh embedded(box_.mesh, box_.incidence, box_.faces, render);
    NamedPieces pieces(box_.mesh, box_.incidence);
    pieces.Break(broken);
    embedded.Break(broken, pieces);
    EXPECT_EQ(embedded.gaps(), 0);
    ExpectSound(embedded, pieces);
  }

  // Edges across the plane x = 0.9, between two layers of nodes, up to a height.
  std::vector<int32_t> CutUpTo(double height) const {
    std::vector<int32_t> cut;
    for (int32_t edge = 0; edge < static_cast<int32_t>(box_.incidence.edge_count()); ++edge) {
      const auto [a, b] = box_.incidence.edges[static_cast<size_t>(edge)];
      const Vec3& p = box_.mesh.rest_positions[static_cast<size_t>(a)];
      const Vec3& q = box_.mesh.rest_positions[static_cast<size_t>(b)];
      if ((p[0] < 0.9) != (q[0] < 0.9) && std::max(p[1], q[1]) < height) cut.push_back(edge);
    }
    return cut;
  }

  static constexpr Vec3 kSize{2, 1.2, 1};
  const SurfaceCase box_{KuhnBox({6, 4, 3}, kSize)};
};

TEST_F(EmbeddedMeshTest, WholeIsTheMeshThatWasGiven) {
  const RenderMesh render = FineBox({12, 9, 8}, kSize, [](const Vec3& at) { return at; });
  EmbeddedMesh embedded(box_.mesh, box_.incidence, box_.faces, render);
  const NamedPieces pieces(box_.mesh, box_.incidence);
  embedded.Break({}, pieces);
  ExpectSound(embedded, pieces);
  EXPECT_EQ(embedded.topology().triangles.size(), embedded.divided().triangles.size());
  for (size_t i = 0; i < embedded.sources().size(); ++i) {
    const auto source = static_cast<size_t>(embedded.sources()[i]);
    // Texture coordinates are those of the triangle behind, wherever it was divided.
    for (size_t k = 0; k < 3; ++k) {
      const auto point = static_cast<size_t>(embedded.topology().triangles[i][k]);
      EXPECT_NEAR(embedded.uvs()[i][k][0], embedded.topology().points[point].rest[0], 1e-6);
    }
    ASSERT_LT(source, render.triangles.size());
  }
}

TEST_F(EmbeddedMeshTest, BreaksWithThePiecesIntoClosedParts) {
  const auto as_it_is = [](const Vec3& at) { return at; };
  const auto scaled = [](double scale) {
    return [scale](const Vec3& at) {
      Vec3 moved{};
      for (size_t axis = 0; axis < 3; ++axis)
        moved[axis] = 0.5 * kSize[axis] + scale * (at[axis] - 0.5 * kSize[axis]);
      return moved;
    };
  };
  const auto wavy = [](const Vec3& at) {
    return Vec3{at[0] + 0.03 * std::sin(9 * at[1]), at[1] + 0.03 * std::sin(8 * at[2] + 1),
                at[2] + 0.03 * std::sin(7 * at[0] + 2)};
  };
  std::vector<RenderMesh> meshes;
  meshes.push_back(FineBox({12, 9, 8}, kSize, as_it_is));
  meshes.push_back(FineBox({11, 10, 9}, kSize, scaled(1.08)));
  meshes.push_back(FineBox({13, 9, 8}, kSize, scaled(0.9)));
  meshes.push_back(FineBox({12, 11, 10}, kSize, wavy));
  meshes.push_back(FineBox({1, 1, 1}, kSize, scaled(1.03)));  // twelve triangles
  for (size_t m = 0; m < meshes.size(); ++m) {
    for (uint64_t seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(std::to_string(m) + " " + std::to_string(seed));
      ASSERT_NO_FATAL_FAILURE(ExpectSoundWithout(Shatter(seed, 2 + 3 * seed), meshes[m]));
      // Cracks that end somewhere, and pieces of any kind.
      ASSERT_NO_FATAL_FAILURE(ExpectSoundWithout(
          box_.RandomEdges(seed, 0.15 * static_cast<double>(seed + 1)), meshes[m]));
    }
    // Every node a piece.
    std::vector<int32_t> all(box_.incidence.edges.size());
    std::iota(all.begin(), all.end(), 0);
    ASSERT_NO_FATAL_FAILURE(ExpectSoundWithout(all, meshes[m]));
  }
}

// The nearest face of the body jumps from one wall of a slot to the other, in the middle of what
// the render mesh spans across it, however finely that is divided.
TEST_F(EmbeddedMeshTest, PiecesOfABodyWithASlotThatTheRenderMeshBridgesAreClosed) {
  TetMesh slotted = KuhnBox({6, 6, 4}, kSize);
  std::erase_if(slotted.tets, [&](const auto& tet) {
    Vec3 middle{};
    for (const int32_t node : tet) {
      for (size_t axis = 0; axis < 3; ++axis)
        middle[axis] += slotted.rest_positions[static_cast<size_t>(node)][axis] / 4;
    }
    return middle[1] > 0.4 && middle[0] > 2.0 / 3 && middle[0] < 1;
  });
  const SurfaceCase body(std::move(slotted));
  const RenderMesh render = FineBox({8, 6, 5}, kSize, [](const Vec3& at) { return at; });
  for (uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<int32_t> broken =
        body.RandomEdges(seed, seed == 0 ? 1.1 : 0.25 * static_cast<double>(seed));
    EmbeddedMesh embedded(body.mesh, body.incidence, body.faces, render);
    EXPECT_GT(embedded.gaps(), 0);
    NamedPieces pieces(body.mesh, body.incidence);
    // In two steps, the first of which must leave nothing behind.
    const auto half = std::span(broken).first(broken.size() / 2);
    pieces.Break(half);
    embedded.Break(half, pieces);
    ASSERT_NO_FATAL_FAILURE(ExpectSound(embedded, pieces));
    const auto rest = std::span(broken).subspan(half.size());
    pieces.Break(rest);
    embedded.Break(rest, pieces);
    ASSERT_NO_FATAL_FAILURE(ExpectSound(embedded, pieces));
  }
}

TEST_F(EmbeddedMeshTest, PiecesHaveTheVolumesOfTheirCornerCells) {
  // The render mesh is the body's own boundary, cut along the plane between two layers of nodes.
  const RenderMesh render = FineBox({12, 12, 12}, kSize, [](const Vec3& at) { return at; });
  EmbeddedMesh embedded(box_.mesh, box_.incidence, box_.faces, render);
  NamedPieces pieces(box_.mesh, box_.incidence);
  const std::vector<int32_t> cut = CutUpTo(10);
  pieces.Break(cut);
  ASSERT_EQ(pieces.count(), 2);
  embedded.Break(cut, pieces);
  // Crack faces stay between the layers, whatever points they share.
  const double low = 2.0 / 3, high = 1;
  for (size_t i = 0; i < embedded.topology().triangles.size(); ++i) {
    if (embedded.topology().inside[i] == 0) continue;
    for (const int32_t point : embedded.topology().triangles[i]) {
      const Vec3& rest = embedded.topology().points[static_cast<size_t>(point)].rest;
      EXPECT_GT(rest[0], low);
      EXPECT_LT(rest[0], high);
      for (size_t axis = 1; axis < 3; ++axis) {
        EXPECT_GE(rest[axis], -1e-9);
        EXPECT_LE(rest[axis], kSize[axis] + 1e-9);
      }
    }
  }
  std::array<double, 2> volumes{};
  for (size_t i = 0; i < embedded.topology().triangles.size(); ++i) {
    std::array<Vector3d, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      const auto point = static_cast<size_t>(embedded.topology().triangles[i][k]);
      corners[k] = Vector3d(embedded.topology().points[point].rest.data());
    }
    volumes[static_cast<size_t>(pieces.piece_of(embedded.topology().nodes[i]))] +=
        corners[0].dot(corners[1].cross(corners[2])) / 6;
  }
  for (size_t piece = 0; piece < 2; ++piece)
    EXPECT_NEAR(volumes[piece], pieces.volume(static_cast<int32_t>(piece)), 0.01 * 2.4);
}

TEST_F(EmbeddedMeshTest, FollowsRigidMotionsOfEachPieceExactly) {
  EmbeddedMesh embedded(box_.mesh, box_.incidence, box_.faces,
                        FineBox({11, 9, 8}, kSize, [](const Vec3& at) {
                          return Vec3{1.05 * at[0], 1.05 * at[1], 1.05 * at[2]};
                        }));
  const std::vector<int32_t> broken = Shatter(3, 4);
  NamedPieces pieces(box_.mesh, box_.incidence);
  pieces.Break(broken);
  embedded.Break(broken, pieces);
  const auto turned = [&](const Vec3& at, int32_t piece) {
    const Matrix3d rotation =
        Eigen::AngleAxisd(0.4 + piece, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    Vec3 moved{};
    Eigen::Map<Vector3d>(moved.data()) =
        rotation * Vector3d(at.data()) + Vector3d(piece, -2.0 * piece, 1);
    return moved;
  };
  std::vector<Vec3> positions = box_.mesh.rest_positions;
  for (size_t node = 0; node < positions.size(); ++node)
    positions[node] = turned(positions[node], pieces.piece_of(static_cast<int32_t>(node)));
  std::vector<Vec3> points;
  PointMotion(box_.mesh, box_.incidence).Move(embedded.topology(), positions, points);
  // A piece whose nodes have all lost their live tets does not know that it turns.
  std::vector<uint8_t> live(static_cast<size_t>(pieces.count()), 0);
  for (size_t tet = 0; tet < box_.mesh.tets.size(); ++tet) {
    if (Separated(embedded.topology().tet_masks[tet])) continue;
    live[static_cast<size_t>(pieces.piece_of(box_.mesh.tets[tet][0]))] = 1;
  }
  size_t checked = 0;
  for (size_t i = 0; i < embedded.topology().triangles.size(); ++i) {
    const int32_t node = embedded.topology().nodes[i];
    const int32_t piece = pieces.piece_of(node);
    if (live[static_cast<size_t>(piece)] == 0) continue;
    for (const int32_t point : embedded.topology().triangles[i]) {
      const SurfacePoint& at = embedded.topology().points[static_cast<size_t>(point)];
      bool owners_live = true;
      for (size_t k = 0; k < at.node_count; ++k) {
        if ((at.owners >> k & 1) == 0) continue;
        bool has = false;
        for (const int32_t tet : box_.incidence.node_tets[at.nodes[k]])
          has = has || !Separated(embedded.topology().tet_masks[static_cast<size_t>(tet)]);
        owners_live = owners_live && has;
      }
      if (!owners_live) continue;
      const Vec3 expected = turned(at.rest, piece);
      for (size_t axis = 0; axis < 3; ++axis)
        ASSERT_NEAR(points[static_cast<size_t>(point)][axis], expected[axis], 1e-12);
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000u);
}

TEST_F(EmbeddedMeshTest, CracksThatCutNothingOffOpenAndCloseAtTheirTips) {
  const RenderMesh render = FineBox({24, 16, 12}, kSize, [](const Vec3& at) { return at; });
  EmbeddedMesh embedded(box_.mesh, box_.incidence, box_.faces, render);
  NamedPieces pieces(box_.mesh, box_.incidence);
  const std::vector<int32_t> cut = CutUpTo(0.7);
  pieces.Break(cut);
  ASSERT_EQ(pieces.count(), 1);
  embedded.Break(cut, pieces);
  ASSERT_NO_FATAL_FAILURE(ExpectSound(embedded, pieces));
  // The right part turns about the upper edge of the cut: the crack opens like a book.
  std::vector<Vec3> positions = box_.mesh.rest_positions;
  for (Vec3& at : positions) {
    if (at[0] > 0.9) at[0] += 0.1 * (kSize[1] - at[1]);
  }
  std::vector<Vec3> points;
  PointMotion(box_.mesh, box_.incidence).Move(embedded.topology(), positions, points);
  // How far copies of a place come apart, by height.
  const SurfaceTopology& surface = embedded.topology();
  std::map<Vec3, std::vector<double>> copies;
  for (size_t i = 0; i < points.size(); ++i) copies[surface.points[i].rest].push_back(points[i][0]);
  double widest = 0;
  double highest = 0;
  for (const auto& [rest, places] : copies) {
    const auto [low, high] = std::minmax_element(places.begin(), places.end());
    if (places.size() < 2) continue;
    EXPECT_LE(*high - *low, 0.1 * (kSize[1] - rest[1]) + 0.05) << rest[1];
    widest = std::max(widest, *high - *low);
    highest = std::max(highest, rest[1]);
  }
  EXPECT_NEAR(widest, 0.12, 0.03);  // at the mouth
  EXPECT_GT(highest, 0.5);
  EXPECT_LT(highest, 0.95);  // closed above
  // Nothing on either side is stretched across the crack.
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<size_t>(surface.triangles[i][k]);
      const auto b = static_cast<size_t>(surface.triangles[i][(k + 1) % 3]);
      if (surface.points[a].rest[1] > 0.5 || surface.points[b].rest[1] > 0.5) continue;
      const double before =
          (Vector3d(surface.points[a].rest.data()) - Vector3d(surface.points[b].rest.data()))
              .norm();
      const double now = (Vector3d(points[a].data()) - Vector3d(points[b].data())).norm();
      EXPECT_LT(now, before + 0.035);
    }
  }
}

TEST_F(EmbeddedMeshTest, BreakingBitByBitGivesTheSameAsAtOnceAndCostsWhatBroke) {
  const RenderMesh render = FineBox({12, 9, 8}, kSize, [](const Vec3& at) {
    return Vec3{at[0] + 0.03 * std::sin(9 * at[1]), at[1], at[2] + 0.03 * std::sin(7 * at[0])};
  });
  const auto by_id = [](const EmbeddedMesh& embedded) {
    const SurfaceTopology& surface = embedded.topology();
    std::map<SurfaceId, std::tuple<std::array<SurfaceId, 3>, int32_t, CornerUvs>> triangles;
    for (size_t i = 0; i < surface.triangles.size(); ++i) {
      std::array<SurfaceId, 3> corners{};
      for (size_t k = 0; k < 3; ++k)
        corners[k] = surface.point_ids[static_cast<size_t>(surface.triangles[i][k])];
      triangles[surface.triangle_ids[i]] = {corners, embedded.sources()[i], embedded.uvs()[i]};
    }
    std::map<SurfaceId, std::pair<Vec3, uint8_t>> points;
    for (size_t i = 0; i < surface.points.size(); ++i)
      points[surface.point_ids[i]] = {surface.points[i].rest, surface.points[i].owners};
    return std::pair(triangles, points);
  };
  std::vector<int32_t> broken = box_.RandomEdges(5, 0.5);
  EmbeddedMesh bit_by_bit(box_.mesh, box_.incidence, box_.faces, render);
  NamedPieces pieces(box_.mesh, box_.incidence);
  int64_t dearest = 0;
  std::map<SurfaceId, Vec3> rests;
  for (const int32_t edge : broken) {
    pieces.Break(std::array{edge});
    dearest = std::max(dearest, bit_by_bit.Break(std::array{edge}, pieces));
    // A point that is there stays where it is at rest.
    const SurfaceTopology& surface = bit_by_bit.topology();
    for (size_t i = 0; i < surface.points.size(); i += 7)
      ASSERT_EQ(rests.emplace(surface.point_ids[i], surface.points[i].rest).first->second,
                surface.points[i].rest);
  }
  EmbeddedMesh at_once(box_.mesh, box_.incidence, box_.faces, render);
  at_once.Break(broken, pieces);
  EXPECT_TRUE(by_id(bit_by_bit) == by_id(at_once));
  EXPECT_GT(dearest, 0);
  EXPECT_LT(dearest, static_cast<int64_t>(at_once.divided().triangles.size()) / 8);
}

}  // namespace
}  // namespace cleave
