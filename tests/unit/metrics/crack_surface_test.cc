#include "tests/metrics/crack_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

// Edges whose ends lie on different sides.
std::vector<int32_t> CutBetween(const TetMesh& mesh, const Incidence& incidence,
                                const std::function<bool(const Vec3&)>& side) {
  std::vector<int32_t> cut;
  for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
    const auto& [a, b] = incidence.edges[edge];
    if (side(mesh.rest_positions[static_cast<size_t>(a)]) !=
        side(mesh.rest_positions[static_cast<size_t>(b)]))
      cut.push_back(static_cast<int32_t>(edge));
  }
  return cut;
}

TEST(CrackSurface, APlaneBetweenLayersIsFlatAndWhole) {
  const TetMesh mesh = KuhnBox({4, 3, 2}, {4, 3, 2});
  const Incidence incidence = BuildIncidence(mesh);
  const auto crack = CrackSurface(
      mesh, incidence, CutBetween(mesh, incidence, [](const Vec3& x) { return x[0] < 1.5; }));
  EXPECT_NEAR(CrackArea(crack), 6, 1e-12);
  EXPECT_NEAR(FibreCrossing(crack, {1, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(FibreCrossing(crack, {0, 1, 0}), 0, 1e-12);
  EXPECT_NEAR(FibreCrossing(crack, {std::sqrt(0.5), 0, std::sqrt(0.5)}), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(CrackCenter(crack)[0], 1.5, 1e-12);
  EXPECT_NEAR(CrackCenter(crack)[1], 1.5, 1e-12);
  EXPECT_NEAR(DistanceFromPlane(crack, {2, 7, 7}, {3, 0, 0}, 0.9), 0.5, 1e-12);
  EXPECT_NEAR(ExtentAlong(crack, {1, 0, 0}, 0.05).length(), 0, 1e-12);
  EXPECT_GT(ExtentAlong(crack, {0, 1, 0}, 0.05).length(), 2);
}

TEST(CrackSurface, AnIntactBodyAndABrokenEdgeAloneHaveNone) {
  const TetMesh mesh = KuhnBox({2, 2, 2}, {2, 2, 2});
  const Incidence incidence = BuildIncidence(mesh);
  EXPECT_TRUE(CrackSurface(mesh, incidence, {}).empty());
  const std::vector<int32_t> one = {3};
  EXPECT_TRUE(CrackSurface(mesh, incidence, one).empty());
  EXPECT_EQ(FibreCrossing({}, Vec3{1, 0, 0}), 0);
}

TEST(CrackSurface, ATetThatFellApartCountsEachInterfaceOnce) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  const Incidence incidence = BuildIncidence(mesh);
  const std::vector<int32_t> all = {0, 1, 2, 3, 4, 5};
  // A triangle round each vertex, of area 1/8 or sqrt(3)/8, half of which is its side.
  EXPECT_NEAR(CrackArea(CrackSurface(mesh, incidence, all)), (3 + std::sqrt(3)) / 16, 1e-12);
}

TEST(CrackSurface, DustHasNoCrack) {
  const TetMesh mesh = KuhnBox({9, 6, 6}, {9, 6, 6});
  const Incidence incidence = BuildIncidence(mesh);
  // One node in the middle comes free: below 0.5 % of the body.
  const std::vector<int32_t> loose = CutBetween(mesh, incidence, [](const Vec3& x) {
    return x == Vec3{4, 3, 3};
  });
  const double area = CrackArea(CrackSurface(mesh, incidence, loose));
  EXPECT_GT(area, 0);
  // What is left is the wall of the hole.
  EXPECT_NEAR(CrackArea(CrackOfPieces(mesh, incidence, loose)), area / 2, 1e-12);
}

TEST(CrackSurface, SmoothingLeavesThePlaneThatAStaircaseFollows) {
  const TetMesh mesh = KuhnBox({16, 16, 4}, {16, 16, 4});
  const Incidence incidence = BuildIncidence(mesh);
  const double slope = std::atan(0.4);
  const auto crack = CrackSurface(mesh, incidence, CutBetween(mesh, incidence, [](const Vec3& x) {
                                    return x[1] < 0.4 * x[0] + 5.1;
                                  }));
  const Vec3 along = {std::cos(slope), std::sin(slope), 0};
  const double rough = FibreCrossing(crack, along);
  const double smooth = FibreCrossing(SmoothedCrack(crack, 3), along);
  EXPECT_GT(rough, 0.2);
  EXPECT_LT(smooth, 0.5 * rough);
  // A flat crack stays what it is.
  const auto flat = CrackSurface(
      mesh, incidence, CutBetween(mesh, incidence, [](const Vec3& x) { return x[0] < 1.5; }));
  EXPECT_NEAR(FibreCrossing(SmoothedCrack(flat, 3), {0.6, 0.8, 0}), 0.6, 1e-9);
}

TEST(CrackSurface, PartsAreWhatStepsOfTheReachJoin) {
  const TetMesh mesh = KuhnBox({12, 3, 3}, {12, 3, 3});
  const Incidence incidence = BuildIncidence(mesh);
  // Three planes, the first two of them two cells apart.
  const auto crack = CrackSurface(mesh, incidence, CutBetween(mesh, incidence, [](const Vec3& x) {
                                    return x[0] < 1.5 || (x[0] > 3.5 && x[0] < 9.5);
                                  }));
  ASSERT_NEAR(CrackArea(crack), 27, 1e-9);
  const auto parts = CrackParts(crack, 1);
  ASSERT_EQ(parts.size(), 3);
  size_t facets = 0;
  for (const auto& part : parts) {
    EXPECT_NEAR(CrackArea(part), 9, 1e-9);
    EXPECT_NEAR(ExtentAlong(part, {1, 0, 0}, 0).length(), 0, 1e-9);
    facets += part.size();
  }
  EXPECT_EQ(facets, crack.size());
  EXPECT_EQ(parts[0].front().center, crack.front().center);
  // A longer reach joins the two that are near.
  const auto joined = CrackParts(crack, 3);
  ASSERT_EQ(joined.size(), 2);
  EXPECT_NEAR(std::max(CrackArea(joined[0]), CrackArea(joined[1])), 18, 1e-9);
  EXPECT_EQ(CrackParts(crack, 20).size(), 1);
  EXPECT_TRUE(CrackParts({}, 1).empty());
}

TEST(CrackSurface, ATraceIsTheLineAlongManyFacets) {
  const TetMesh mesh = KuhnBox({24, 24, 1}, {24, 24, 1});
  const Incidence incidence = BuildIncidence(mesh);
  const auto crack = CrackSurface(mesh, incidence, CutBetween(mesh, incidence, [](const Vec3& x) {
                                    return x[1] < 0.5 * x[0] + 6.2;
                                  }));
  const double slope = std::atan(0.5) * 180 / M_PI;
  EXPECT_NEAR(TraceAngle(crack, {0, 0, 1}, 4, {1, 0, 0}), slope, 4);
  EXPECT_NEAR(TraceAngle(crack, {0, 0, 1}, 4, {0, -1, 0}), 90 - slope, 4);
  EXPECT_LT(TraceAngle(crack, {0, 0, 1}, 4, {2, 1, 0}), 4);
  EXPECT_EQ(TraceAngle({}, {0, 0, 1}, 4, {1, 0, 0}), 90);
}

}  // namespace
}  // namespace cleave
