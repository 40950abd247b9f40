#include "core/contact/signed_distance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/mesh/surface_distance.h"
#include "tests/unit/core/contact/test_surfaces.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

Vector3d RandomPoint(uint64_t index, double reach) {
  Vector3d point;
  for (uint64_t k = 0; k < 3; ++k)
    point[static_cast<int>(k)] =
        reach * (2 * UniformDraw(7, RandomStream::kMeshJitter, index, k) - 1);
  return point;
}

// The gradient of the value, where it has one, is the normal.
void ExpectNormalIsGradient(const ShapeDistance& shape, const Vector3d& point) {
  constexpr double kStep = 1e-6;
  const SignedDistance here = shape.At(point);
  EXPECT_NEAR(here.normal.norm(), 1, 1e-12);
  Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = kStep * Vector3d::Unit(axis);
    gradient[axis] = (shape.At(point + step).value - shape.At(point - step).value) / (2 * kStep);
  }
  // On a medial surface there is none.
  if (gradient.norm() > 1 - 1e-6) {
    EXPECT_LT((gradient - here.normal).norm(), 1e-5) << point.transpose();
  }
}

TEST(SignedDistance, OfAPlaneIsTheHeightAboveIt) {
  const ShapeDistance plane(PlaneShape{{1, 0, 2}, {0, 0, 3}});
  EXPECT_DOUBLE_EQ(plane.At({5, -7, 2.5}).value, 0.5);
  EXPECT_DOUBLE_EQ(plane.At({5, -7, 1}).value, -1);
  EXPECT_EQ(plane.At({5, -7, 1}).normal, Vector3d(0, 0, 1));
  EXPECT_TRUE(std::isinf(plane.radius()));
}

TEST(SignedDistance, OfASphereHasANormalEvenAtItsCentre) {
  const ShapeDistance sphere(SphereShape{{1, 2, 3}, 0.5});
  EXPECT_DOUBLE_EQ(sphere.At({1, 2, 5}).value, 1.5);
  EXPECT_DOUBLE_EQ(sphere.At({1, 2, 3}).value, -0.5);
  EXPECT_EQ(sphere.At({1, 2, 3}).normal.norm(), 1);
  for (uint64_t k = 0; k < 20; ++k) ExpectNormalIsGradient(sphere, RandomPoint(k, 4));
}

TEST(SignedDistance, OfABoxIsThatOfItsFacesEdgesAndCorners) {
  const ShapeDistance box(BoxShape{{0, 0, 0}, {2, 4, 6}, {0, 0, 1}, 0});
  EXPECT_DOUBLE_EQ(box.At({2, 0, 0}).value, 1);
  EXPECT_DOUBLE_EQ(box.At({4, 6, 0}).value, 5);  // 3, 4 from an edge
  EXPECT_EQ(box.At({4, 6, 0}).normal, Vector3d(0.6, 0.8, 0));
  EXPECT_DOUBLE_EQ(box.At({-2, -4, -5}).value, 3);  // 1, 2, 2 from a corner
  EXPECT_EQ(box.At({-2, -4, -5}).normal, Vector3d(-1, -2, -2) / 3);
  EXPECT_DOUBLE_EQ(box.At({-0.75, 0, 0}).value, -0.25);
  EXPECT_EQ(box.At({-0.75, 0, 0}).normal, Vector3d(-1, 0, 0));
}

TEST(SignedDistance, OfATurnedBoxIsThatOfItsSurface) {
  const BoxShape shape{{0.3, -0.2, 0.1}, {1, 0.6, 0.8}, {1, 2, 2}, 0.7};
  const ShapeDistance box{Shape(shape)};
  SurfaceShape surface = BoxSurface({0, 0, 0}, shape.size);
  const Eigen::AngleAxisd turn(0.7, Vector3d(1, 2, 2).normalized());
  for (Vec3& vertex : surface.vertices) {
    const Vector3d moved = turn * Vector3d(vertex[0], vertex[1], vertex[2]);
    for (size_t i = 0; i < 3; ++i) vertex[i] = shape.center[i] + moved[static_cast<int>(i)];
  }
  const ShapeDistance mesh{Shape(surface)};
  for (uint64_t k = 0; k < 500; ++k) {
    const Vector3d point = RandomPoint(k, 1.2);
    EXPECT_NEAR(box.At(point).value, mesh.At(point).value, 1e-12) << point.transpose();
    ExpectNormalIsGradient(box, point);
    ExpectNormalIsGradient(mesh, point);
  }
}

// Distance to a triangle by dense sampling, and inside by the solid angle of all triangles.
double SlowDistance(const SurfaceShape& surface, const Vector3d& point) {
  double nearest = 1e300, angle = 0;
  for (const auto& triangle : surface.triangles) {
    Vector3d corners[3];
    for (size_t i = 0; i < 3; ++i) {
      const Vec3& v = surface.vertices[static_cast<size_t>(triangle[i])];
      corners[i] = Vector3d(v[0], v[1], v[2]) - point;
    }
    constexpr int kSteps = 60;
    for (int a = 0; a <= kSteps; ++a) {
      for (int b = 0; a + b <= kSteps; ++b) {
        const Vector3d sample =
            (a * corners[0] + b * corners[1] + (kSteps - a - b) * corners[2]) / kSteps;
        nearest = std::min(nearest, sample.norm());
      }
    }
    const double la = corners[0].norm(), lb = corners[1].norm(), lc = corners[2].norm();
    angle += 2 * std::atan2(corners[0].dot(corners[1].cross(corners[2])),
                            la * lb * lc + corners[0].dot(corners[1]) * lc +
                                corners[1].dot(corners[2]) * la + corners[2].dot(corners[0]) * lb);
  }
  return angle > 6 ? -nearest : nearest;
}

TEST(SignedDistance, OfASurfaceMatchesBruteForce) {
  SurfaceShape surface = SphereSurface({0.1, 0.2, -0.1}, 1, 1);
  // Dents make vertices and edges concave.
  for (size_t k = 0; k < surface.vertices.size(); k += 3) {
    for (double& x : surface.vertices[k]) x *= 0.4;
  }
  const ShapeDistance shape{Shape(surface)};
  int inside = 0;
  for (uint64_t k = 0; k < 300; ++k) {
    const Vector3d point = RandomPoint(k, 1.3);
    const double slow = SlowDistance(surface, point);
    EXPECT_NEAR(shape.At(point).value, slow, 0.02) << point.transpose();
    if (std::abs(slow) > 0.02) {
      EXPECT_EQ(shape.At(point).value < 0, slow < 0);
    }
    inside += slow < 0;
  }
  EXPECT_GT(inside, 20);
}

TEST(SignedDistance, OfASurfaceNearsThatOfTheSphereItIsMadeOf) {
  const ShapeDistance sphere(SphereShape{{1, 1, 1}, 0.5});
  const ShapeDistance surface{Shape(SphereSurface({1, 1, 1}, 0.5, 4))};
  for (uint64_t k = 0; k < 200; ++k) {
    const Vector3d point = Vector3d(1, 1, 1) + RandomPoint(k, 1);
    // The sagitta of the largest facets.
    EXPECT_NEAR(surface.At(point).value, sphere.At(point).value, 2e-3);
  }
}

TEST(SignedDistance, OnAVertexTheNormalStillPointsOut) {
  const ShapeDistance surface{Shape(BoxSurface({0, 0, 0}, {2, 2, 2}))};
  const SignedDistance at = surface.At({1, 1, 1});
  EXPECT_EQ(at.value, 0);
  EXPECT_LT((at.normal - Vector3d(1, 1, 1).normalized()).norm(), 1e-12);
}

// Three points on a line through the origin, at these multiples of `along`.
SurfaceDistance Sliver(const Vector3d& along, const std::array<double, 3>& places) {
  std::vector<Vec3> vertices;
  for (const double place : places)
    vertices.push_back({place * along[0], place * along[1], place * along[2]});
  return SurfaceDistance(vertices, {{0, 1, 2}});
}

TEST(SurfaceDistance, OfATriangleWithoutAreaIsThatOfItsLongestSide) {
  const Vector3d along(0.1, 0.7, -0.3);
  for (const std::array<double, 3>& places :
       {std::array<double, 3>{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {0, 0, 2}, {0, 2, 0}, {0, 2, 2}}) {
    const SurfaceDistance surface = Sliver(along, places);
    for (const double at : {-0.5, 0.3, 0.9, 1.1, 1.7, 2.5}) {
      const Vector3d point = at * along + 3 * along.unitOrthogonal();
      const double over = at < 0 ? at : std::max(at - 2, 0.0);  // the end
      const double distance = std::hypot(3, over * along.norm());
      EXPECT_NEAR(std::abs(surface.At(point).value), distance, 1e-12);
      EXPECT_NEAR(surface.ClosestPoint(point).distance, distance, 1e-12);
    }
  }
}

TEST(SurfaceDistance, WeightsLieBetweenTheCornersOfAnyTriangle) {
  for (uint64_t k = 0; k < 200; ++k) {
    const Vector3d along = RandomPoint(k, 1);
    const std::array<double, 3> places = {RandomPoint(1000 + k, 1)[0], RandomPoint(1000 + k, 1)[1],
                                          RandomPoint(1000 + k, 1)[2]};
    const Vector3d point = RandomPoint(2000 + k, 1);
    const SurfacePoint closest = Sliver(along, places).ClosestPoint(point);
    Vector3d there = Vector3d::Zero();
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_GE(closest.weights[i], -1e-12);
      EXPECT_LE(closest.weights[i], 1 + 1e-12);
      there += closest.weights[i] * places[i] * along;
    }
    EXPECT_NEAR((point - there).norm(), closest.distance, 1e-12);
  }
}

TEST(SurfaceDistance, OfTrianglesAsNearTheFirstIsTheClosestWhateverElseThereIs) {
  // A grid of squares of two triangles, and points above their corners, which up to six share.
  constexpr int32_t kSide = 9;
  std::vector<Vec3> vertices;
  std::vector<std::array<int32_t, 3>> triangles;
  for (int32_t i = 0; i < kSide; ++i) {
    for (int32_t j = 0; j < kSide; ++j) {
      const int32_t at = static_cast<int32_t>(vertices.size());
      vertices.push_back({static_cast<double>(i), static_cast<double>(j), 0});
      if (i == 0 || j == 0) continue;
      triangles.push_back({at - kSide - 1, at - 1, at});
      triangles.push_back({at - kSide - 1, at, at - kSide});
    }
  }
  std::reverse(triangles.begin(), triangles.end());
  const SurfaceDistance surface(vertices, triangles);
  for (size_t vertex = 0; vertex < vertices.size(); ++vertex) {
    const auto first = std::find_if(triangles.begin(), triangles.end(), [&](const auto& corners) {
      return std::count(corners.begin(), corners.end(), static_cast<int32_t>(vertex)) > 0;
    });
    const Vec3& at = vertices[vertex];
    EXPECT_EQ(surface.ClosestPoint({at[0], at[1], 0.5}).triangle, first - triangles.begin());
  }
}

}  // namespace
}  // namespace cleave
