#include "client/cli/run_colliders.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cleave {
namespace {

Scene SceneWithBall() {
  Scene scene;
  scene.colliders.resize(2);
  scene.colliders[0].shape = PlaneShape{};
  scene.colliders[1].shape = SphereShape{{1, 0, 0}, 0.5};
  return scene;
}

constexpr char kReports[] =
    "{\"frame\":1,\"time\":0.1,\"colliders\":[{\"rotation\":[1,0,0,0],\"translation\":[0,0,0]},"
    "{\"rotation\":[1,0,0,0],\"translation\":[0,0,3]}]}\n"
    "{\"frame\":2,\"colliders\":[{\"rotation\":[1,0,0,0],\"translation\":[0,0,0]},"
    "{\"rotation\":[1,0,0,0],\"translation\":[0,0,5]}]}\n";

TEST(RunColliders, ShownCollidersTakeTheirOwnPlacesOfTheReports) {
  const std::vector<Prop> props = PropsOfRun(SceneWithBall(), kReports);
  ASSERT_EQ(props.size(), 1u);  // the plane is left out
  const auto top_of = [&](int64_t frame) {
    double top = -1e9;
    for (const Vec3& point : props[0].PointsAt(frame)) top = std::max(top, point[2]);
    return top;
  };
  EXPECT_DOUBLE_EQ(top_of(0), 0.5);
  EXPECT_DOUBLE_EQ(top_of(1), 3.5);
  EXPECT_DOUBLE_EQ(top_of(2), 5.5);
  EXPECT_DOUBLE_EQ(top_of(9), 5.5);
}

TEST(RunColliders, TheLastLineOfAFrameCounts) {
  const auto places = ColliderPlacesOfReports(
      "{\"frame\":4,\"colliders\":[{\"translation\":[1,0,0]}]}\n"
      "{\"frame\":4,\"colliders\":[{\"translation\":[2,0,0]}]}\n");
  ASSERT_EQ(places.size(), 1u);
  ASSERT_EQ(places[0].count(4), 1u);
  EXPECT_EQ(places[0].at(4).translation[0], 2);
}

TEST(RunColliders, TornAndForeignLinesAreLeftOut) {
  EXPECT_TRUE(
      ColliderPlacesOfReports("not json\n{\"frame\":1,\"colliders\":[{\"rotation\":[1,0").empty());
  EXPECT_TRUE(
      ColliderPlacesOfReports("{\"frame\":1,\"colliders\":[{\"translation\":[1,2]}]}\n").empty());
  EXPECT_TRUE(ColliderPlacesOfReports("{\"colliders\":[{\"translation\":[1,2,3]}]}\n").empty());
  EXPECT_TRUE(ColliderPlacesOfReports("").empty());
}

}  // namespace
}  // namespace cleave
