#include "client/io/export/volume_cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <set>

#include "client/io/export/vtu.h"

namespace cleave {
namespace {

TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.1, 0.3, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

// Volume of a hexahedron in VTK's order with plane faces, by the five tets that fill it.
double HexahedronVolume(const VolumeCells& cells, size_t first) {
  constexpr std::array<std::array<size_t, 4>, 5> kParts = {
      {{0, 1, 3, 4}, {1, 2, 3, 6}, {1, 4, 5, 6}, {3, 4, 6, 7}, {1, 3, 4, 6}}};
  const auto at = [&](size_t k) {
    const auto id = static_cast<size_t>(cells.connectivity[first + k]);
    return Eigen::Vector3d(cells.topology.points[id].rest.data());
  };
  double sum = 0;
  for (const auto& [a, b, c, d] : kParts) {
    Eigen::Matrix3d edges;
    edges << at(b) - at(a), at(c) - at(a), at(d) - at(a);
    EXPECT_GT(edges.determinant(), 0);
    sum += edges.determinant() / 6;
  }
  return sum;
}

TEST(VolumeCells, AWholeTetStays) {
  const VolumeCells cells = BuildVolumeCells(OneTet(), std::vector<EdgeMask>{0});
  EXPECT_THAT(cells.types, ::testing::ElementsAre(kVtuTetrahedron));
  EXPECT_THAT(cells.connectivity, ::testing::ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(cells.offsets, ::testing::ElementsAre(4));
}

TEST(VolumeCells, CornerCellsFillASeparatedTetWithAQuarterEach) {
  const TetMesh mesh = OneTet();
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) {
    edges.col(k) = Eigen::Vector3d(mesh.rest_positions[static_cast<size_t>(k) + 1].data());
  }
  for (int mask = 0; mask < kEdgeMasks; ++mask) {
    if (!Separated(static_cast<EdgeMask>(mask))) continue;
    const VolumeCells cells = BuildVolumeCells(mesh, std::vector{static_cast<EdgeMask>(mask)});
    ASSERT_EQ(cells.types, std::vector<uint8_t>(4, kVtuHexahedron));
    ASSERT_EQ(cells.offsets, (std::vector<int64_t>{8, 16, 24, 32}));
    EXPECT_EQ(cells.cell_nodes, (std::vector<int32_t>{0, 1, 2, 3}));
    for (size_t cell = 0; cell < 4; ++cell) {
      EXPECT_NEAR(HexahedronVolume(cells, 8 * cell), edges.determinant() / 24, 1e-15) << mask;
    }
    for (size_t i = 0; i < cells.topology.points.size(); ++i) {
      EXPECT_NE(cells.topology.points[i].owners, 0);
    }
  }
}

TEST(VolumeCells, SeparatedVerticesShareNoPointAndJoinedOnesDo) {
  // Vertex 3 alone: edges 03, 13, 23 are bits 2, 4, 5.
  const VolumeCells cells = BuildVolumeCells(OneTet(), std::vector<EdgeMask>{0b110100});
  const auto points = [&](size_t cell) {
    const auto begin = cells.connectivity.begin() + static_cast<int64_t>(8 * cell);
    return std::set<int64_t>(begin, begin + 8);
  };
  for (const int64_t id : points(3)) {
    for (size_t cell = 0; cell < 3; ++cell) EXPECT_EQ(points(cell).count(id), 0u);
  }
  size_t shared = 0;
  for (const int64_t id : points(0)) shared += points(1).count(id);
  EXPECT_EQ(shared, 4u);  // the face between two corner cells
}

}  // namespace
}  // namespace cleave
