#include "core/mesh/delaunay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/base/counter_rng.h"
#include "core/mesh/grid_predicates.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

double Draw(uint64_t index, uint64_t axis) {
  return UniformDraw(7, RandomStream::kMeshJitter, index, axis);
}

TetMesh MeshOf(std::vector<Vec3> points) {
  TetMesh mesh;
  mesh.tets = DelaunayTets(points);
  mesh.rest_positions = std::move(points);
  return mesh;
}

double VolumeOf(const TetMesh& mesh) {
  double volume = 0;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) volume += SignedVolume(CornersOf(mesh, tet));
  return volume;
}

TEST(GridPredicates, AreExact) {
  constexpr double kFar = 8388607;  // the grid's last step
  const GridPoint a{0, 0, 0, 0};
  const GridPoint b{kFar, 0, 0, 0};
  const GridPoint c{0, kFar, 0, 0};
  const GridPoint d{0, 0, kFar, 0};
  EXPECT_EQ(Orientation(a, b, c, d), 1);
  EXPECT_EQ(Orientation(a, c, b, d), -1);
  // One step off a plane through far corners, and on it.
  EXPECT_EQ(Orientation(b, c, d, {kFar - 2, 1, 1, 0}), 0);
  EXPECT_EQ(Orientation(b, c, d, {kFar - 1, 1, 1, 0}) * Orientation(b, c, d, {kFar - 3, 1, 1, 0}),
            -1);
  // The far corner of the cube lies on the sphere of these four; a step beside it does not.
  EXPECT_EQ(InSphere(a, b, c, d, {kFar, kFar, kFar, 0}), 0);
  EXPECT_EQ(InSphere(a, b, c, d, {kFar - 1, kFar, kFar, 0}), 1);
  EXPECT_EQ(InSphere(a, b, c, d, {1, 1, 1, 0}), 1);
  EXPECT_EQ(InSphere(a, b, c, {0, 0, kFar - 1, 0}, {kFar, kFar, kFar, 0}), -1);
  // On the sphere, weights decide.
  EXPECT_EQ(InSphere(a, b, c, d, {kFar, kFar, kFar, 1}) * InSphere({0, 0, 0, 1}, {kFar, 0, 0, 1},
                                                                   {0, kFar, 0, 1}, {0, 0, kFar, 1},
                                                                   {kFar, kFar, kFar, 0}),
            -1);
}

TEST(DelaunayTets, FillTheHullOfRandomPoints) {
  std::vector<Vec3> points;
  for (uint64_t i = 0; i < 8; ++i)
    points.push_back({i % 2 * 1.0, i / 2 % 2 * 1.0, i / 4 % 2 * 1.0});
  for (uint64_t i = 0; i < 600; ++i) points.push_back({Draw(i, 0), Draw(i, 1), Draw(i, 2)});
  TetMesh mesh = MeshOf(points);
  EXPECT_NEAR(VolumeOf(mesh), 1, 1e-6);
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  for (const Fault& warning : faults.warnings())
    EXPECT_EQ(warning.description.find("nodes"), std::string::npos) << warning.description;
}

TEST(DelaunayTets, HaveEmptySpheres) {
  std::vector<Vec3> points;
  for (uint64_t i = 0; i < 200; ++i) points.push_back({Draw(i, 0), Draw(i, 1), Draw(i, 2)});
  const TetMesh mesh = MeshOf(points);
  ASSERT_GT(mesh.tet_count(), 600);
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const TetCorners c = CornersOf(mesh, tet);
    // Centre from |x - c0|^2 = |x - ck|^2.
    Eigen::Matrix3d rows;
    Eigen::Vector3d right;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = c[static_cast<size_t>(k + 1)] - c[0];
      rows.row(k) = 2 * d.transpose();
      right[k] = d.squaredNorm();
    }
    const Eigen::Vector3d centre = c[0] + rows.inverse() * right;
    const double radius = (centre - c[0]).norm();
    for (const Vec3& p : points) {
      EXPECT_GT((Eigen::Map<const Eigen::Vector3d>(p.data()) - centre).norm(), radius * (1 - 1e-4));
    }
  }
}

TEST(DelaunayTets, TakeCosphericalAndCoplanarPoints) {
  std::vector<Vec3> points;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 4; ++k) points.push_back({i * 1.0, j * 1.0, k * 1.0});
  TetMesh mesh = MeshOf(points);
  EXPECT_NEAR(VolumeOf(mesh), 5 * 4 * 3, 1e-9);
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  EXPECT_EQ(faults.warning_count(), 0);
}

TEST(DelaunayTets, OfTooFewOrFlatOrEqualPointsAreNone) {
  EXPECT_TRUE(DelaunayTets({}).empty());
  EXPECT_TRUE(DelaunayTets({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).empty());
  EXPECT_TRUE(DelaunayTets({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}).empty());
  EXPECT_TRUE(DelaunayTets(std::vector<Vec3>(9, Vec3{3, 3, 3})).empty());
  EXPECT_EQ(DelaunayTets({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}}).size(),
            1u);
}

}  // namespace
}  // namespace cleave
