#include "core/surface/point_motion.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>

#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<Vec3> Mapped(const std::vector<Vec3>& positions, const Matrix3d& matrix,
                         const Vector3d& offset) {
  std::vector<Vec3> mapped(positions.size());
  for (size_t i = 0; i < positions.size(); ++i)
    Eigen::Map<Vector3d>(mapped[i].data()) = matrix * Vector3d(positions[i].data()) + offset;
  return mapped;
}

void ExpectNear(const std::vector<Vec3>& actual, const std::vector<Vec3>& expected,
                double tolerance) {
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t i = 0; i < actual.size(); ++i) {
    for (size_t axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(actual[i][axis], expected[i][axis], tolerance) << "point " << i;
  }
}

class PointMotionTest : public ::testing::Test {
 protected:
  const SurfaceCase box_{KuhnBox({4, 4, 3}, {1.2, 1, 0.8})};
  const Matrix3d rotation_ =
      Eigen::AngleAxisd(2.5, Vector3d(0.3, -1, 0.7).normalized()).toRotationMatrix();
  const Vector3d offset_{3, -5, 2};
};

TEST_F(PointMotionTest, AtRestGivesTheRestPoints) {
  for (const bool smooth : {false, true}) {
    const SurfaceTopology surface = box_.Extract(box_.RandomEdges(1, 0.5), smooth);
    std::vector<Vec3> points;
    PointMotion(box_.mesh, box_.incidence).Move(surface, box_.mesh.rest_positions, points);
    ExpectNear(points, RestPoints(surface), 1e-14);
  }
}

TEST_F(PointMotionTest, FollowsAffineMotionsOfPiecesWithLiveTets) {
  // Rigid, and stretched within what is allowed; breaks few enough that every owner has a live tet.
  const std::vector<int32_t> broken = box_.RandomEdges(3, 0.3);
  const Matrix3d stretched = rotation_ * Vector3d(1.5, 0.7, 1.1).asDiagonal();
  for (const bool smooth : {false, true}) {
    const SurfaceTopology surface = box_.Extract(broken, smooth);
    int copies = 0;
    for (const SurfacePoint& point : surface.points) copies += point.owned_by_all() ? 0 : 1;
    ASSERT_GT(copies, 50);
    for (const Matrix3d& matrix : {rotation_, stretched}) {
      std::vector<Vec3> points;
      PointMotion(box_.mesh, box_.incidence)
          .Move(surface, Mapped(box_.mesh.rest_positions, matrix, offset_), points);
      ExpectNear(points, Mapped(RestPoints(surface), matrix, offset_), 1e-12);
    }
  }
}

TEST_F(PointMotionTest, ANodeWithoutLiveTetsKeepsItsLastDeformation) {
  // Whole and turned in one frame, all apart in the next: each node's cell stays turned.
  PointMotion motion(box_.mesh, box_.incidence);
  std::vector<Vec3> points;
  const std::vector<Vec3> turned = Mapped(box_.mesh.rest_positions, rotation_, offset_);
  motion.Move(box_.Extract({}), turned, points);
  std::vector<int32_t> all;
  for (int32_t edge = 0; edge < static_cast<int32_t>(box_.incidence.edge_count()); ++edge)
    all.push_back(edge);
  const SurfaceTopology apart = box_.Extract(all);
  motion.Move(apart, turned, points);
  ExpectNear(points, Mapped(RestPoints(apart), rotation_, offset_), 1e-12);
  // The nodes fly on without turning: so do their cells.
  const std::vector<Vec3> later = Mapped(turned, Matrix3d::Identity(), Vector3d(1, 2, 3));
  motion.Move(apart, later, points);
  ExpectNear(points, Mapped(RestPoints(apart), rotation_, offset_ + Vector3d(1, 2, 3)), 1e-12);
}

TEST_F(PointMotionTest, HoldsWildStretchesWithinBounds) {
  // Stretched a hundredfold: a copy beside a crack lies at most five half-edges from its node.
  const SurfaceTopology surface = box_.Extract(box_.RandomEdges(3, 0.3));
  const Matrix3d wild = Vector3d(100, 100, 100).asDiagonal();
  const std::vector<Vec3> positions = Mapped(box_.mesh.rest_positions, wild, Vector3d::Zero());
  std::vector<Vec3> points;
  PointMotion(box_.mesh, box_.incidence).Move(surface, positions, points);
  int checked = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& point = surface.points[i];
    if (point.owners != 1 || point.node_count < 2) continue;
    const auto node = static_cast<size_t>(point.nodes[0]);
    const Vector3d at_rest =
        Vector3d(point.rest.data()) - Vector3d(box_.mesh.rest_positions[node].data());
    const Vector3d moved = Vector3d(points[i].data()) - Vector3d(positions[node].data());
    EXPECT_NEAR(moved.norm(), 5 * at_rest.norm(), 1e-10);
    ++checked;
  }
  EXPECT_GT(checked, 10);
}

TEST_F(PointMotionTest, GivesTheSameBitsForAnyNumberOfThreads) {
  const SurfaceCase box(KuhnBox({12, 12, 10}, {1.2, 1, 0.8}));
  const SurfaceTopology surface = box.Extract(box.RandomEdges(5, 0.4), true);
  const std::vector<Vec3> positions = Mapped(box.mesh.rest_positions, rotation_, offset_);
  std::vector<Vec3> one, two;
  tbb::task_arena(1).execute(
      [&] { PointMotion(box.mesh, box.incidence).Move(surface, positions, one); });
  tbb::task_arena(2).execute(
      [&] { PointMotion(box.mesh, box.incidence).Move(surface, positions, two); });
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace cleave
