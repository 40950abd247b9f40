#include "core/scene/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cleave {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Two tets on a common face, the first in region 5 "bark", the second in region 7.
TetMesh TwoRegions() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  mesh.tet_regions = {5, 7};
  mesh.regions = {{5, "bark"}};
  return mesh;
}

std::vector<int32_t> Select(std::vector<Selector> selectors) {
  const TetMesh mesh = TwoRegions();
  return SelectNodes({"set", std::move(selectors)}, mesh, RegionIndex(mesh));
}

TEST(SelectNodes, TakesTheBoundaryOfEveryShape) {
  EXPECT_THAT(Select({BoxSelector{{0, 0, 0}, {1, 0, 0}}}), ElementsAre(0, 1));
  EXPECT_THAT(Select({SphereSelector{{0, 0, 0}, 1}}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(Select({PlaneSelector{{0, 0, 1}, {0, 0, 2}}}), ElementsAre(3, 4));
}

TEST(SelectNodes, TakesRegionsByNameAndById) {
  EXPECT_THAT(Select({RegionSelector{"bark"}}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(Select({RegionSelector{"7"}}), ElementsAre(1, 2, 3, 4));
}

TEST(SelectNodes, UnitesItsSelectorsWithoutRepeats) {
  EXPECT_THAT(Select({IdSelector{{4, 0, 4}}, SphereSelector{{0, 0, 0}, 0.5}}), ElementsAre(0, 4));
}

TEST(SelectNodes, OfUnknownThingsIsEmpty) {
  EXPECT_THAT(Select({RegionSelector{"leaf"}, IdSelector{{-1, 5}}}), IsEmpty());
}

TEST(AssignMaterials, LetsLaterMaterialsWin) {
  const TetMesh mesh = TwoRegions();
  const RegionIndex regions(mesh);
  Material everywhere, bark;
  bark.regions = {"bark"};
  EXPECT_THAT(AssignMaterials({everywhere, bark}, mesh, regions), ElementsAre(1, 0));
  EXPECT_THAT(AssignMaterials({bark, everywhere}, mesh, regions), ElementsAre(1, 1));
  EXPECT_THAT(AssignMaterials({bark}, mesh, regions), ElementsAre(0, -1));
}

}  // namespace
}  // namespace cleave
