#include "core/mesh/surface_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/quality.h"
#include "core/mesh/surface_distance.h"
#include "core/mesh/winding_number.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;
using Triangles = std::vector<std::array<int32_t, 3>>;

struct Surface {
  std::vector<Vec3> vertices;
  Triangles triangles;
};

// A ball of `rings` rings of triangles, of radius 1 about a point.
Surface Ball(int rings, Vec3 center = {0, 0, 0}) {
  Surface ball;
  const int across = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < across; ++j) {
      const double down = std::numbers::pi * i / rings, turn = std::numbers::pi * j / rings;
      ball.vertices.push_back({center[0] + std::sin(down) * std::cos(turn),
                               center[1] + std::sin(down) * std::sin(turn),
                               center[2] + std::cos(down)});
    }
  }
  // All nodes of a pole are the first one.
  const auto node = [&](int i, int j) {
    return i * across + (i == 0 || i == rings ? 0 : j % across);
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < across; ++j) {
      const int a = node(i, j), b = node(i, j + 1), c = node(i + 1, j), d = node(i + 1, j + 1);
      if (i > 0) ball.triangles.push_back({a, c, b});
      if (i + 1 < rings) ball.triangles.push_back({b, c, d});
    }
  }
  return ball;
}

// A box of 2 x 1 x 1 m from the origin; its first two triangles are the bottom.
Surface Box() {
  return {{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1}},
          {{0, 2, 1},
           {0, 3, 2},
           {4, 5, 6},
           {4, 6, 7},
           {0, 1, 5},
           {0, 5, 4},
           {1, 2, 6},
           {1, 6, 5},
           {2, 3, 7},
           {2, 7, 6},
           {3, 0, 4},
           {3, 4, 7}}};
}

MeshResolution Cells(double size, MeshLayout layout = MeshLayout::kJitteredLattice) {
  MeshResolution resolution;
  resolution.cell_size = size;
  resolution.layout = layout;
  return resolution;
}

constexpr MeshLayout kLayouts[] = {MeshLayout::kJitteredLattice, MeshLayout::kUnstructured};

MeshReport Report(TetMesh mesh) {
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  EXPECT_EQ(faults.warning_count(), 0);
  return ReportMesh(mesh, BuildIncidence(mesh));
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  const Surface ball = Ball(24);
  const WindingNumber winding(ball.vertices, ball.triangles);
  for (const double radius : {0.0, 0.3, 0.9, 0.98}) {
    EXPECT_NEAR(winding.At({radius, 0, 0}), 1, 0.02) << radius;
    EXPECT_NEAR(winding.At({0, -radius, 0.1}), 1, 0.02) << radius;
  }
  for (const double radius : {1.02, 1.5, 9.0})
    EXPECT_NEAR(winding.At({radius, 0.1, 0}), 0, 0.02) << radius;
}

TEST(WindingNumber, ClosesAnOpenBoxAtItsRim) {
  Surface box = Box();
  box.triangles.erase(box.triangles.begin(), box.triangles.begin() + 2);
  const WindingNumber winding(box.vertices, box.triangles);
  EXPECT_GT(winding.At({1, 0.5, 0.05}), 0.5);
  EXPECT_LT(winding.At({1, 0.5, -0.05}), 0.5);
}

TEST(MeshSurface, FillsABall) {
  const Surface ball = Ball(24);
  const SurfaceDistance distance(ball.vertices, ball.triangles);
  for (const MeshLayout layout : kLayouts) {
    const auto body = MeshSurface(ball.vertices, ball.triangles, Cells(0.25, layout));
    ASSERT_TRUE(body.ok()) << body.status();
    const MeshReport report = Report(body->mesh);
    EXPECT_EQ(report.component_count, 1);
    EXPECT_EQ(body->open_edges, 0);
    EXPECT_NEAR(report.volume / body->surface_volume, 1, 0.03);
    EXPECT_GT(report.min_dihedral, 8 * std::numbers::pi / 180);
    EXPECT_NEAR(report.edge_length.mean, 0.25, 0.05);
    // Nodes are inside, or on the surface.
    for (const Vec3& at : body->mesh.rest_positions)
      EXPECT_LT(distance.At({at[0], at[1], at[2]}).value, 0.02);
  }
}

TEST(MeshSurface, KeepsSharpEdges) {
  const Surface box = Box();
  for (const MeshLayout layout : kLayouts) {
    const auto body = MeshSurface(box.vertices, box.triangles, Cells(0.12, layout));
    ASSERT_TRUE(body.ok()) << body.status();
    const MeshReport report = Report(body->mesh);
    EXPECT_NEAR(report.volume, 2, 0.04);
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(report.min_corner[axis], 0, 0.01);
      EXPECT_NEAR(report.max_corner[axis], axis == 0 ? 2 : 1, 0.01);
    }
  }
}

TEST(MeshSurface, ClosesHolesJoinsWhatOverlapsAndTurnsWhatIsInsideOut) {
  Surface box = Box();
  box.triangles.erase(box.triangles.begin(), box.triangles.begin() + 2);
  const auto closed = MeshSurface(box.vertices, box.triangles, Cells(0.2));
  ASSERT_TRUE(closed.ok()) << closed.status();
  EXPECT_EQ(closed->open_edges, 4);
  EXPECT_NEAR(closed->surface_volume, 2, 1e-12);
  EXPECT_NEAR(Report(closed->mesh).volume, 2, 0.1);

  Surface pair = Ball(16);
  const Surface other = Ball(16, {1, 0, 0});
  for (auto triangle : other.triangles) {
    for (int32_t& vertex : triangle) vertex += static_cast<int32_t>(pair.vertices.size());
    pair.triangles.push_back(triangle);
  }
  pair.vertices.insert(pair.vertices.end(), other.vertices.begin(), other.vertices.end());
  const auto joined = MeshSurface(pair.vertices, pair.triangles, Cells(0.25));
  ASSERT_TRUE(joined.ok()) << joined.status();
  EXPECT_EQ(Report(joined->mesh).component_count, 1);
  // Two balls less their lens of 5 pi / 12.
  EXPECT_NEAR(Report(joined->mesh).volume, 8 * std::numbers::pi / 3 - 5 * std::numbers::pi / 12,
              0.4);

  Surface turned = Ball(16);
  for (auto& triangle : turned.triangles) std::swap(triangle[0], triangle[1]);
  const auto body = MeshSurface(turned.vertices, turned.triangles, Cells(0.4));
  ASSERT_TRUE(body.ok()) << body.status();
  EXPECT_GT(body->surface_volume, 4);
}

TEST(MeshSurface, GivesTheSameBitsAndOthersForAnotherSeed) {
  const Surface ball = Ball(12);
  MeshResolution cells = Cells(0.4);
  const auto first = MeshSurface(ball.vertices, ball.triangles, cells);
  EXPECT_EQ(first->mesh.rest_positions,
            MeshSurface(ball.vertices, ball.triangles, cells)->mesh.rest_positions);
  cells.seed = 2;
  EXPECT_NE(first->mesh.rest_positions,
            MeshSurface(ball.vertices, ball.triangles, cells)->mesh.rest_positions);
}

TEST(MeshSurface, SaysWhatItCannotMesh) {
  const Surface box = Box();
  const auto error = [](const Surface& surface, const MeshResolution& cells) {
    const auto body = MeshSurface(surface.vertices, surface.triangles, cells);
    EXPECT_EQ(body.status().code(), absl::StatusCode::kInvalidArgument) << body.status();
    return std::string(body.status().message());
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error(box, Cells(0)), HasSubstr("cell_size: 0 is outside"));
  EXPECT_THAT(error(box, Cells(kNan)), HasSubstr("cell_size"));
  EXPECT_THAT(error(box, Cells(1e-4)), HasSubstr("tets"));
  EXPECT_THAT(error(box, Cells(2.5)), HasSubstr("cell_size"));
  EXPECT_THAT(error({box.vertices, {}}, Cells(0.2)), HasSubstr("triangles: is empty"));
  EXPECT_THAT(error({box.vertices, {{0, 1, 8}}}, Cells(0.2)),
              HasSubstr("triangles[0]: names vertex 8 of 8"));
  Surface spoilt = box;
  spoilt.vertices[3][1] = kNan;
  EXPECT_THAT(error(spoilt, Cells(0.2)), HasSubstr("vertices[3]"));
  // A sheet goes round nothing.
  EXPECT_THAT(error({box.vertices, {box.triangles[0], box.triangles[1]}}, Cells(0.2)),
              HasSubstr("encloses nothing"));
}

}  // namespace
}  // namespace cleave
