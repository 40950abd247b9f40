#include "core/mesh/mesh_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/counter_rng.h"
#include "core/mesh/mesh_limits.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

auto Is(const std::string& field, const std::string& text) {
  return AllOf(Field(&Fault::field, field), Field(&Fault::description, HasSubstr(text)));
}

TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

TetMesh TwoTets() {
  TetMesh mesh = OneTet();
  mesh.rest_positions.push_back({1, 1, 1});
  mesh.tets.push_back({1, 2, 3, 4});
  return mesh;
}

TEST(MeshCheck, AcceptsASoundMeshWithoutAWord) {
  TetMesh mesh = TwoTets();
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(faults.ok());
  EXPECT_THAT(faults.warnings(), IsEmpty());
}

TEST(MeshCheck, RefusesAMeshWithoutTets) {
  TetMesh mesh;
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(), ElementsAre(Is("tets", "there are none")));
}

TEST(MeshCheck, NamesNodesThatAreNotFiniteOrTooFar) {
  TetMesh mesh = TwoTets();
  mesh.rest_positions[1][2] = std::numeric_limits<double>::quiet_NaN();
  mesh.rest_positions[3][0] = -std::numeric_limits<double>::infinity();
  mesh.rest_positions[4][1] = 2e9;
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(),
              ElementsAre(Is("rest_positions[1]", "nan"), Is("rest_positions[3]", "-inf"),
                          Is("rest_positions[4]", "2e+09")));
}

TEST(MeshCheck, NamesIdsOutOfRangeAndRepeated) {
  TetMesh mesh = TwoTets();
  mesh.tets[0][1] = -1;
  mesh.tets[1][3] = 5;
  mesh.tets.push_back({3, 0, 1, 3});
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(),
              ElementsAre(Is("tets[0]", "node -1 is outside [0, 5)"), Is("tets[1]", "node 5"),
                          Is("tets[2]", "node 3 twice")));
}

TEST(MeshCheck, RefusesFlatTets) {
  TetMesh mesh = OneTet();
  mesh.rest_positions[3] = {0.3, 0.3, 1e-15};
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(), ElementsAre(Is("tets[0]", "is flat")));
  mesh.rest_positions[3] = {0.3, 0.3, 1e-12};
  const Faults sliver = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(sliver.ok());
  EXPECT_THAT(sliver.warnings(), ElementsAre(Is("tets", "sliver")));
}

TEST(MeshCheck, RefusesLengthsBelowAnAtom) {
  TetMesh mesh = OneTet();
  for (Vec3& p : mesh.rest_positions)
    for (double& x : p) x *= 1e-120;
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(), ElementsAre(Is("tets[0]", "shortest edge")));
}

TEST(MeshCheck, TolerancesAreRelative) {
  for (const double scale : {1e-9, 1e-3, 1.0, 1e6}) {
    TetMesh mesh = TwoTets();
    for (Vec3& p : mesh.rest_positions)
      for (double& x : p) x *= scale;
    const Faults faults = CheckAndOrientMesh(mesh);
    EXPECT_TRUE(faults.ok()) << scale;
    EXPECT_THAT(faults.warnings(), IsEmpty()) << scale;
  }
}

TEST(MeshCheck, RefusesAFaceOfThreeTets) {
  TetMesh mesh = TwoTets();
  mesh.rest_positions.push_back({2, 2, 2.5});
  mesh.tets.push_back({1, 2, 3, 5});
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(),
              ElementsAre(Is("tets[2]", "face (1, 2, 3) is shared by 3 tets (0, 1, 2)")));
}

TEST(MeshCheck, RefusesTwoTetsOnOneSideOfAFace) {
  TetMesh mesh = OneTet();
  mesh.rest_positions.push_back({0.1, 0.1, 0.2});
  mesh.tets.push_back({1, 3, 2, 4});  // on the inner side of face (1, 2, 3), whatever its order
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(),
              ElementsAre(Is("tets[1]", "same side of face (1, 2, 3)")));
}

TEST(MeshCheck, RefusesDuplicateTetsOnceEach) {
  TetMesh mesh = TwoTets();
  mesh.tets.push_back({3, 1, 0, 2});
  mesh.tets.push_back({0, 1, 2, 3});
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(),
              UnorderedElementsAre(Is("tets[2]", "as tets[0]"), Is("tets[3]", "as tets[0]")));
}

TEST(MeshCheck, RefusesMoreThanIdsCanCount) {
  EXPECT_TRUE(CheckMeshCounts(limits::kMaxNodes, limits::kMaxTets).ok());
  EXPECT_THAT(CheckMeshCounts(limits::kMaxNodes + 1, limits::kMaxTets + 1).errors(),
              ElementsAre(Is("tets", "64000001 are more than 64000000"),
                          Is("rest_positions", "64000001 nodes are more than 64000000")));
}

TEST(MeshCheck, RefusesRegionArraysThatDoNotFit) {
  TetMesh mesh = TwoTets();
  mesh.tet_regions = {1};
  mesh.regions = {{1, "a"}, {2, "b"}, {1, "c"}};
  EXPECT_THAT(CheckAndOrientMesh(mesh).errors(),
              ElementsAre(Is("tet_regions", "1 items for 2 tets"), Is("regions[2]", "regions[0]")));
}

TEST(MeshCheck, TurnsTetsToPositiveVolume) {
  TetMesh mesh = TwoTets();
  std::swap(mesh.tets[1][0], mesh.tets[1][1]);
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(faults.ok());
  EXPECT_THAT(faults.warnings(), ElementsAre(Is("tets", "1 have negative orientation")));
  for (int64_t tet = 0; tet < 2; ++tet) EXPECT_GT(SignedVolume(CornersOf(mesh, tet)), 0);
  EXPECT_THAT(CheckAndOrientMesh(mesh).warnings(), IsEmpty());
}

TEST(MeshCheck, CountsUnreferencedAndCoincidentNodesAndKeepsThem) {
  TetMesh mesh = TwoTets();
  mesh.rest_positions.push_back({9, 9, 9});
  mesh.rest_positions.push_back({1, 0, 1e-10});
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(faults.ok());
  EXPECT_THAT(faults.warnings(), ElementsAre(Is("rest_positions", "2 nodes are in no tet"),
                                             Is("rest_positions", "1 nodes lie on another node")));
  EXPECT_EQ(mesh.node_count(), 7);
}

TEST(MeshCheck, TakesPartsThatTouchAtANodeOrNowhere) {
  TetMesh mesh = OneTet();
  mesh.rest_positions.insert(mesh.rest_positions.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  mesh.tets.push_back({0, 4, 6, 5});
  const TetMesh other = OneTet();
  for (const Vec3& p : other.rest_positions) mesh.rest_positions.push_back({p[0] + 5, p[1], p[2]});
  mesh.tets.push_back({7, 8, 9, 10});
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_TRUE(faults.ok());
}

TEST(MeshCheck, TellsFarMoreFaultsThanItKeepsByNumber) {
  TetMesh mesh = OneTet();
  mesh.tets.assign(100'000, {0, 1, 2, 77});
  const Faults faults = CheckAndOrientMesh(mesh);
  EXPECT_EQ(faults.error_count(), 100'000);
  EXPECT_EQ(faults.errors().size(), static_cast<size_t>(Faults::kMaxKept));
}

// Random meshes of ids in and out of range, sizes that disagree and odd coordinates: only that it
// returns, and that what it passes is sound.
TEST(MeshCheck, IsTotal) {
  int passed = 0;
  for (uint64_t round = 0; round < 20'000; ++round) {
    uint64_t draw = 0;
    const auto random = [&](double below) {
      return UniformDraw(round, RandomStream::kMeshJitter, draw++, 0) * below;
    };
    TetMesh mesh;
    const auto nodes = static_cast<int32_t>(random(9));
    for (int32_t node = 0; node < nodes; ++node) {
      Vec3 p{random(1), random(1), random(1)};
      if (random(1) < 0.02) p[0] = std::numeric_limits<double>::quiet_NaN();
      if (random(1) < 0.02) p[1] = 1e308;
      if (random(1) < 0.05) p = {0, 0, 0};
      mesh.rest_positions.push_back(p);
    }
    const auto tets = static_cast<int32_t>(random(5));
    for (int32_t tet = 0; tet < tets; ++tet) {
      std::array<int32_t, 4> ids;
      for (int32_t& id : ids) id = static_cast<int32_t>(random(nodes + 0.1));
      if (random(1) < 0.02) ids[2] = std::numeric_limits<int32_t>::min();
      mesh.tets.push_back(ids);
    }
    if (random(1) < 0.2) mesh.tet_regions.resize(static_cast<size_t>(random(5)));
    if (!CheckAndOrientMesh(mesh).ok()) continue;
    ++passed;
    for (int64_t tet = 0; tet < mesh.tet_count(); ++tet)
      EXPECT_GT(SignedVolume(CornersOf(mesh, tet)), 0);
  }
  EXPECT_GT(passed, 100);
}

}  // namespace
}  // namespace cleave
