#include "core/mesh/procedural.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/quality.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180;

BoxMesh Box(MeshLayout layout, double cell_size, Vec3 size = {1, 0.6, 0.4}) {
  return {{0.1, -0.2, 0.3}, size, {layout, cell_size, 0.2, 1}};
}
CylinderMesh Cylinder(MeshLayout layout, double cell_size) {
  return {{0.1, -0.2, 0.3}, 0.3, 1, {layout, cell_size, 0.2, 1}};
}
TubeMesh Tube(MeshLayout layout, double cell_size) {
  return {{0.1, -0.2, 0.3}, 0.5, 0.35, 1, {layout, cell_size, 0.2, 1}};
}
DiscMesh Disc(MeshLayout layout, double cell_size) {
  return {{0.1, -0.2, 0.3}, 0.5, 0.05, {layout, cell_size, 0.2, 1}};
}

double RadiusAt(const Vec3& p) { return std::hypot(p[0] - 0.1, p[1] + 0.2); }

// Builds a shape and holds it to what every procedural mesh promises.
template <typename Shape>
TetMesh Sound(const Shape& shape, MeshReport* report = nullptr) {
  absl::StatusOr<TetMesh> built = BuildMesh(shape);
  if (!built.ok()) {
    ADD_FAILURE() << built.status();
    return {};
  }
  TetMesh mesh = *std::move(built);
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  EXPECT_THAT(faults.warnings(), IsEmpty())
      << (faults.warnings().empty() ? "" : faults.warnings()[0].description);
  const MeshReport its = ReportMesh(mesh, BuildIncidence(mesh));
  EXPECT_EQ(its.component_count, 1);
  const double estimate = EstimateTets(shape);
  EXPECT_LT(static_cast<double>(its.tet_count), 1.5 * estimate);
  EXPECT_GT(static_cast<double>(its.tet_count), estimate / 2);
  if (report != nullptr) *report = its;
  return mesh;
}

class EveryLayout : public ::testing::TestWithParam<MeshLayout> {};
INSTANTIATE_TEST_SUITE_P(Procedural, EveryLayout,
                         ::testing::Values(MeshLayout::kJitteredLattice,
                                           MeshLayout::kUnstructured));

TEST_P(EveryLayout, BoxIsFilledExactly) {
  MeshReport report;
  Sound(Box(GetParam(), 0.1), &report);
  EXPECT_NEAR(report.volume, 0.24, 1e-12);
  EXPECT_NEAR(report.surface_area, 2 * (0.6 + 0.4 + 0.24), 1e-12);
  EXPECT_NEAR(report.min_corner[1], -0.2, 1e-15);
  EXPECT_NEAR(report.max_corner[0], 1.1, 1e-15);
  EXPECT_GT(report.min_dihedral, 8 * kDegree);
}

TEST_P(EveryLayout, CylinderIsInscribed) {
  MeshReport report;
  const TetMesh mesh = Sound(Cylinder(GetParam(), 0.06), &report);
  const double full = std::numbers::pi * 0.09;
  EXPECT_LT(report.volume, full);
  EXPECT_GT(report.volume, 0.985 * full);
  EXPECT_GT(report.min_dihedral, 8 * kDegree);
  for (const Vec3& p : mesh.rest_positions) EXPECT_LE(RadiusAt(p), 0.3 + 1e-12);
}

TEST_P(EveryLayout, TubeLeavesItsHoleOpen) {
  MeshReport report;
  const TetMesh mesh = Sound(Tube(GetParam(), 0.05), &report);
  EXPECT_NEAR(report.volume, std::numbers::pi * (0.25 - 0.1225), 0.01);
  EXPECT_GT(report.min_dihedral, 8 * kDegree);
  for (const Vec3& p : mesh.rest_positions) {
    EXPECT_LE(RadiusAt(p), 0.5 + 1e-12);
    EXPECT_GE(RadiusAt(p), 0.35 - 1e-12);
  }
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const TetCorners corners = CornersOf(mesh, tet);
    const Eigen::Vector3d centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
    EXPECT_GT(std::hypot(centre[0] - 0.1, centre[1] + 0.2), 0.345);
  }
}

TEST_P(EveryLayout, DiscHasNodesWithinItsThickness) {
  MeshReport report;
  const TetMesh mesh = Sound(Disc(GetParam(), 0.05), &report);
  EXPECT_NEAR(report.volume, std::numbers::pi * 0.25 * 0.05, 1e-3);
  int inside = 0;
  for (const Vec3& p : mesh.rest_positions) inside += p[2] > 0.301 && p[2] < 0.349;
  EXPECT_GT(inside, 100);
}

TEST_P(EveryLayout, ThinBodiesAndSingleCellsAreSound) {
  Sound(Box(GetParam(), 0.1, {1, 1, 0.013}));
  Sound(Box(GetParam(), 1, {1, 1, 1}));
  Sound(Box(GetParam(), 0.5, {3, 0.05, 0.05}));
  Sound(Disc(GetParam(), 0.2));
  Sound(CylinderMesh{{0, 0, 0}, 0.1, 0.1, {GetParam(), 0.1, 0.2, 1}});
  Sound(CylinderMesh{{0, 0, 0}, 0.1, 4, {GetParam(), 0.1, 0.4, 1}});
  Sound(TubeMesh{{0, 0, 0}, 0.11, 0.1, 0.5, {GetParam(), 0.04, 0.2, 1}});
  Sound(TubeMesh{{0, 0, 0}, 1, 0.1, 0.2, {GetParam(), 0.1, 0.2, 1}});
}

TEST_P(EveryLayout, IsTheSameAtAnyScale) {
  for (const double scale : {1e-6, 1e6}) {
    BoxMesh shape = Box(GetParam(), 0.2 * scale, {scale, scale, scale});
    shape.origin = {0, 0, 0};
    MeshReport report;
    Sound(shape, &report);
    EXPECT_NEAR(report.volume / (scale * scale * scale), 1, 1e-9);
  }
}

TEST_P(EveryLayout, SeedDecidesTheMesh) {
  BoxMesh shape = Box(GetParam(), 0.1);
  const TetMesh first = Sound(shape);
  const TetMesh again = Sound(shape);
  EXPECT_EQ(first.rest_positions, again.rest_positions);
  EXPECT_EQ(first.tets, again.tets);
  shape.resolution.seed = 2;
  EXPECT_NE(Sound(shape).rest_positions, first.rest_positions);
}

TEST_P(EveryLayout, RefusesShapesByField) {
  BoxMesh box = Box(GetParam(), -1);
  box.size[1] = std::numeric_limits<double>::quiet_NaN();
  box.resolution.jitter = 0.5;
  box.origin[2] = std::numeric_limits<double>::infinity();
  const absl::Status status = BuildMesh(box).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  for (const char* field : {"resolution.cell_size: -1", "size[1]: nan", "resolution.jitter: 0.5",
                            "origin[2]: inf m is outside"}) {
    EXPECT_THAT(status.message(), HasSubstr(field));
  }
  TubeMesh tube = Tube(GetParam(), 0.05);
  tube.inner_radius = 0.5;
  EXPECT_THAT(BuildMesh(tube).status().message(), HasSubstr("inner_radius: 0.5"));
  tube.inner_radius = 0.49;
  tube.resolution.cell_size = 0.1;
  EXPECT_THAT(BuildMesh(tube).status().message(), HasSubstr("a chord that cuts a quarter"));
  EXPECT_THAT(BuildMesh(Cylinder(GetParam(), 0.4)).status().message(),
              HasSubstr("resolution.cell_size: 0.4 m is too coarse: at most 0.3 m, the radius"));
}

TEST_P(EveryLayout, RefusesTooManyTetsBeforeMakingAny) {
  for (const double cell : {1e-3, 1e-8}) {
    EXPECT_THAT(BuildMesh(Box(GetParam(), cell, {1, 1, 1})).status().message(),
                HasSubstr("resolution.cell_size"));
    EXPECT_THAT(BuildMesh(Disc(GetParam(), cell / 10)).status().message(),
                HasSubstr("at most 64000000"));
  }
}

// Mean of the squared share of an edge's direction that lies along each axis: a third each where no
// direction is preferred.
TEST(Unstructured, PrefersNoDirectionAndHasNoSliver) {
  BoxMesh shape = Box(MeshLayout::kUnstructured, 0.05, {1, 1, 1});
  MeshReport report;
  const TetMesh mesh = Sound(shape, &report);
  EXPECT_GT(report.min_dihedral, 18 * kDegree);
  EXPECT_LT(report.max_dihedral, 160 * kDegree);
  EXPECT_NEAR(report.edge_length.mean, 0.05, 0.004);
  EXPECT_LT(report.edge_length.max, 0.1);
  const Incidence incidence = BuildIncidence(mesh);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  double count = 0;
  for (const auto& [a, b] : incidence.edges) {
    const Eigen::Map<const Eigen::Vector3d> p(mesh.rest_positions[static_cast<size_t>(a)].data());
    const Eigen::Map<const Eigen::Vector3d> q(mesh.rest_positions[static_cast<size_t>(b)].data());
    const Eigen::Vector3d edge = (q - p).normalized();
    squares += edge.cwiseProduct(edge);
    products += Eigen::Vector3d(edge[0] * edge[1], edge[1] * edge[2], edge[2] * edge[0]);
    ++count;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(squares[axis] / count, 1.0 / 3, 0.015);
    EXPECT_NEAR(products[axis] / count, 0, 0.01);
  }
}

TEST(Unstructured, IsSoundForManySeedsAndSizes) {
  for (uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const double cell = 0.08 + 0.01 * seed;
    const MeshResolution resolution{MeshLayout::kUnstructured, cell, 0.2, seed};
    Sound(BoxMesh{{0, 0, 0}, {1, 0.3 + 0.01 * seed, 0.5}, resolution});
    Sound(CylinderMesh{{0, 0, 0}, 0.2 + 0.01 * seed, 1, resolution});
    Sound(TubeMesh{{0, 0, 0}, 0.5, 0.25 + 0.015 * seed, 0.6, resolution});
    Sound(DiscMesh{{0, 0, 0}, 0.6, 0.04 + 0.01 * seed, resolution});
  }
}

// A node that smoothing brings to the very axis has no direction in which to be mirrored.
TEST(Unstructured, TakesANodeOnTheAxis) {
  Sound(DiscMesh{{0, 0, 0},
                 0.20966795161251398,
                 0.18618926273527617,
                 {MeshLayout::kUnstructured, 0.20135080372486092, 0.2, 697}});
}

TEST(JitteredLattice, WithoutJitterIsTheKuhnLattice) {
  BoxMesh shape = Box(MeshLayout::kJitteredLattice, 0.25, {0.5, 0.75, 1});
  shape.origin = {0, 0, 0};
  shape.resolution.jitter = 0;
  const TetMesh mesh = Sound(shape);
  ASSERT_EQ(mesh.node_count(), 3 * 4 * 5);
  ASSERT_EQ(mesh.tet_count(), 6 * 2 * 3 * 4);
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 3; ++j) {
      for (int k = 0; k <= 4; ++k) {
        EXPECT_EQ(mesh.rest_positions[static_cast<size_t>((i * 4 + j) * 5 + k)],
                  (Vec3{0.25 * i, 0.25 * j, 0.25 * k}));
      }
    }
  }
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    EXPECT_NEAR(SignedVolume(CornersOf(mesh, tet)), 1.0 / 64 / 6, 1e-15);
    // Every tet holds its cell's main diagonal, whose ends differ by one step along each axis.
    const auto& nodes = mesh.tets[static_cast<size_t>(tet)];
    const auto [low, high] = std::minmax_element(nodes.begin(), nodes.end());
    EXPECT_EQ(*high - *low, 4 * 5 + 5 + 1);
  }
}

TEST(JitteredLattice, MovesNodesWithinTheirFaces) {
  BoxMesh shape = Box(MeshLayout::kJitteredLattice, 0.1);
  shape.resolution.jitter = 0.4;
  const TetMesh moved = Sound(shape);
  shape.resolution.jitter = 0;
  const TetMesh still = Sound(shape);
  double largest = 0;
  for (size_t node = 0; node < still.rest_positions.size(); ++node) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const double step =
          std::abs(moved.rest_positions[node][axis] - still.rest_positions[node][axis]);
      largest = std::max(largest, step);
      EXPECT_LE(step, 0.04 + 1e-12);
    }
  }
  EXPECT_GT(largest, 0.03);
}

}  // namespace
}  // namespace cleave
