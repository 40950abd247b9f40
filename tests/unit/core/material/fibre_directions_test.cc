#include "core/material/fibre_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

Vec3 Centroid(const TetMesh& mesh, size_t tet) {
  Vec3 centroid{0, 0, 0};
  for (const int32_t node : mesh.tets[tet]) {
    for (size_t i = 0; i < 3; ++i)
      centroid[i] += mesh.rest_positions[static_cast<size_t>(node)][i] / 4;
  }
  return centroid;
}

std::vector<Vec3> OnAllTets(const FibreDirection& direction, const TetMesh& mesh) {
  std::vector<int32_t> tets(mesh.tets.size());
  std::iota(tets.begin(), tets.end(), 0);
  return FibreDirections(direction, mesh, tets);
}

TEST(FibreDirections, AreUnitForAnyLengthOfAConstantVector) {
  const TetMesh mesh = KuhnBox({1, 1, 1}, {1, 1, 1});
  for (const double length : {1e-200, 1.0, 1e200}) {
    for (const Vec3& direction : OnAllTets(ConstantDirection{{3 * length, 0, -4 * length}}, mesh)) {
      EXPECT_NEAR(direction[0], 0.6, 1e-15);
      EXPECT_NEAR(direction[2], -0.8, 1e-15);
    }
  }
}

TEST(FibreDirections, FollowTheFrameOfAnAxis) {
  const TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1}, {1, 2, 3});
  const CylindricalDirection outward{{0, 0, 0}, {0, 0, 2}, {5, 0, 0}};
  const CylindricalDirection around{{0, 0, 0}, {0, 0, 2}, {0, 5, 0}};
  const auto out = OnAllTets(outward, mesh), ring = OnAllTets(around, mesh);
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const Vec3 at = Centroid(mesh, tet);
    const double radius = std::hypot(at[0], at[1]);
    EXPECT_NEAR(out[tet][0], at[0] / radius, 1e-14);
    EXPECT_NEAR(out[tet][1], at[1] / radius, 1e-14);
    EXPECT_NEAR(ring[tet][0], -at[1] / radius, 1e-14);
    EXPECT_NEAR(ring[tet][1], at[0] / radius, 1e-14);
    EXPECT_NEAR(out[tet][2], 0, 1e-14);
  }
}

TEST(FibreDirections, TakeTheRecordOfEachTet) {
  const TetMesh mesh = KuhnBox({1, 1, 1}, {1, 1, 1});
  TetDirections per_tet;
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet)
    per_tet.vectors.push_back({tet % 2 == 0 ? 1.0 : 0, tet % 2 == 0 ? 0.0 : 1, 0});
  const int32_t chosen[] = {1, 4};
  EXPECT_EQ(FibreDirections(per_tet, mesh, chosen), (std::vector<Vec3>{{0, 1, 0}, {1, 0, 0}}));
}

TEST(FibreDirections, FollowACurveWhicheverWayItRuns) {
  const TetMesh mesh = KuhnBox({4, 4, 2}, {1, 1, 0.2}, {-0.5, 0.5, -0.1});
  CurveDirections arc;
  arc.curves.resize(1);
  for (int k = 0; k <= 60; ++k) {
    const double angle = k * 3.14159265358979 / 60;
    arc.curves[0].points.push_back({std::cos(angle), std::sin(angle), 0});
  }
  CurveDirections reversed = arc;
  std::reverse(reversed.curves[0].points.begin(), reversed.curves[0].points.end());
  const auto forth = OnAllTets(arc, mesh), back = OnAllTets(reversed, mesh);
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const Vec3 at = Centroid(mesh, tet);
    const double radius = std::hypot(at[0], at[1]);
    // Nearly tangential; the further from the arc, the more of it counts.
    if (std::abs(radius - 1) > 0.15) continue;
    EXPECT_GT(std::abs(-forth[tet][0] * at[1] + forth[tet][1] * at[0]) / radius, 0.98);
    const double same =
        forth[tet][0] * back[tet][0] + forth[tet][1] * back[tet][1] + forth[tet][2] * back[tet][2];
    EXPECT_NEAR(std::abs(same), 1, 1e-10);
  }
}

TEST(FibreDirections, AtAPointAreThoseOfATetThere) {
  const TetMesh mesh = KuhnBox({1, 1, 1}, {1, 1, 1}, {1, 2, 3});
  const FibreDirection around = CylindricalDirection{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}};
  const Vec3 centroid = Centroid(mesh, 0);
  EXPECT_EQ(FibreDirectionAt(around, centroid), OnAllTets(around, mesh)[0]);
  EXPECT_EQ(FibreDirectionAt(ConstantDirection{{0, 0, 3}}, centroid), (Vec3{0, 0, 1}));
  EXPECT_EQ(FibreDirectionAt(TetDirections{{{1, 0, 0}}}, centroid), std::nullopt);
  EXPECT_EQ(FibreDirectionAt(std::monostate{}, centroid), std::nullopt);
}

}  // namespace
}  // namespace cleave
