#include "core/mesh/quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace cleave {
namespace {

TetMesh RegularTet() {
  TetMesh mesh;
  mesh.rest_positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.tets = {{0, 2, 1, 3}};
  return mesh;
}

TEST(MeshReport, KnowsTheRegularTet) {
  const TetMesh mesh = RegularTet();
  const MeshReport report = ReportMesh(mesh, BuildIncidence(mesh));
  EXPECT_NEAR(std::abs(report.volume), 8.0 / 3, 1e-12);
  EXPECT_NEAR(report.aspect.max, 1, 1e-12);
  EXPECT_NEAR(report.min_dihedral, std::acos(1.0 / 3), 1e-12);
  EXPECT_NEAR(report.max_dihedral, std::acos(1.0 / 3), 1e-12);
  EXPECT_NEAR(report.edge_length.mean, std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(report.surface_area, 8 * std::sqrt(3.0), 1e-12);
  EXPECT_EQ(report.boundary_face_count, 4);
  EXPECT_EQ(report.component_count, 1);
}

TEST(MeshReport, CountsPartsRegionsAndSpareNodes) {
  TetMesh mesh;
  mesh.rest_positions = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                         {1, 1, 1}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 0.01}};
  mesh.tets = {{1, 2, 3, 4}, {2, 3, 4, 5}, {6, 7, 8, 9}};
  mesh.tet_regions = {4, 4, 7};
  mesh.regions = {{7, "thin"}};
  const MeshReport report = ReportMesh(mesh, BuildIncidence(mesh));
  EXPECT_EQ(report.component_count, 2);
  EXPECT_EQ(report.boundary_face_count, 6 + 4);
  EXPECT_EQ(report.unreferenced_node_count, 1);
  EXPECT_EQ(report.max_corner, (Vec3{6, 1, 1}));
  ASSERT_EQ(report.regions.size(), 2u);
  EXPECT_EQ(report.regions[0].id, 4);
  EXPECT_EQ(report.regions[0].tet_count, 2);
  EXPECT_EQ(report.regions[1].name, "thin");
  EXPECT_NEAR(report.regions[1].volume, 0.01 / 6, 1e-15);
  ASSERT_EQ(report.worst.size(), 3u);
  EXPECT_EQ(report.worst[0].tet, 2);
  EXPECT_GT(report.worst[0].aspect, 10);
  EXPECT_NEAR(report.edge_length.min, 0.01, 1e-15);
}

TEST(MeshReport, OfAnEmptyMeshIsEmpty) {
  const MeshReport report = ReportMesh(TetMesh{}, BuildIncidence(TetMesh{}));
  EXPECT_EQ(report.tet_count, 0);
  EXPECT_TRUE(report.worst.empty());
}

}  // namespace
}  // namespace cleave
