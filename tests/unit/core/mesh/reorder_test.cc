#include "core/mesh/reorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/base/counter_rng.h"

namespace cleave {
namespace {

// Nodes scattered at random in a cube, and tets of nodes that lie near each other.
TetMesh Scattered() {
  TetMesh mesh;
  for (uint64_t node = 0; node < 4000; ++node) {
    Vec3 p;
    for (uint64_t axis = 0; axis < 3; ++axis)
      p[axis] = UniformDraw(1, RandomStream::kMeshJitter, node, axis);
    mesh.rest_positions.push_back(p);
  }
  for (int32_t tet = 0; tet < 999; ++tet) {
    mesh.tets.push_back({4 * tet, 4 * tet + 1, 4 * tet + 2, 4 * tet + 3});
    mesh.tet_regions.push_back(tet % 7);
  }
  mesh.regions = {{3, "three"}};
  return mesh;
}

TEST(LocalityOrder, IsAPermutationWithItsInverse) {
  const TetMesh mesh = Scattered();
  const MeshOrder order = LocalityOrder(mesh);
  ASSERT_EQ(order.old_node.size(), mesh.rest_positions.size());
  ASSERT_EQ(order.old_tet.size(), mesh.tets.size());
  for (size_t node = 0; node < order.old_node.size(); ++node)
    EXPECT_EQ(order.new_node[static_cast<size_t>(order.old_node[node])], static_cast<int>(node));
  for (size_t tet = 0; tet < order.old_tet.size(); ++tet)
    EXPECT_EQ(order.new_tet[static_cast<size_t>(order.old_tet[tet])], static_cast<int>(tet));
}

TEST(LocalityOrder, KeepsEveryTetWithItsCornersInOrder) {
  const TetMesh mesh = Scattered();
  const MeshOrder order = LocalityOrder(mesh);
  const TetMesh renumbered = Reordered(mesh, order);
  ASSERT_EQ(renumbered.tet_count(), mesh.tet_count());
  ASSERT_EQ(renumbered.node_count(), mesh.node_count());
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const auto place = static_cast<size_t>(order.new_tet[tet]);
    EXPECT_EQ(renumbered.tet_regions[place], mesh.tet_regions[tet]);
    for (size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(renumbered.rest_positions[static_cast<size_t>(renumbered.tets[place][k])],
                mesh.rest_positions[static_cast<size_t>(mesh.tets[tet][k])]);
    }
  }
  EXPECT_EQ(renumbered.regions.at(0).name, "three");
}

TEST(LocalityOrder, PutsNeighboursNearEachOther) {
  const TetMesh mesh = Scattered();
  const TetMesh renumbered = Reordered(mesh, LocalityOrder(mesh));
  const auto mean_jump = [](const TetMesh& of) {
    double sum = 0;
    for (size_t node = 1; node < of.rest_positions.size(); ++node) {
      for (size_t axis = 0; axis < 3; ++axis)
        sum += std::abs(of.rest_positions[node][axis] - of.rest_positions[node - 1][axis]);
    }
    return sum / static_cast<double>(of.rest_positions.size());
  };
  EXPECT_LT(mean_jump(renumbered), 0.2 * mean_jump(mesh));
}

TEST(LocalityOrder, KeepsTheOrderOfEqualPositions) {
  TetMesh mesh;
  mesh.rest_positions.assign(5, Vec3{2, 2, 2});
  EXPECT_THAT(LocalityOrder(mesh).old_node, ::testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_TRUE(LocalityOrder(TetMesh{}).old_node.empty());
}

}  // namespace
}  // namespace cleave
