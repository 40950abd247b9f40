#include "client/cli/run_plot.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

Scene PulledScene() {
  Scene scene;
  scene.motions.resize(2);
  scene.motions[1].keyframes.resize(2);
  scene.motions[1].keyframes[1].translation = {0, 3, 4};
  return scene;
}

TEST(RunPlot, ForceIsTheFarthestPullsAlongItsWay) {
  const Pull pull = FarthestPull(PulledScene().motions);
  EXPECT_EQ(pull.motion, 1);
  EXPECT_DOUBLE_EQ(pull.direction[1], 0.6);
  const auto samples = SamplesOfReports(
      "{\"frame\":1,\"time\":0.5,\"residual\":null,\"broken_edges\":7,\"fragments\":2,"
      "\"motion_forces\":[[9,9,9],[1,10,5]]}\n",
      PulledScene());
  ASSERT_TRUE(samples.ok()) << samples.status();
  ASSERT_EQ(samples->size(), 1u);
  EXPECT_DOUBLE_EQ((*samples)[0].force, 10);
  EXPECT_DOUBLE_EQ((*samples)[0].time, 0.5);
  EXPECT_EQ((*samples)[0].broken_edges, 7);
  EXPECT_EQ((*samples)[0].pieces, 2);
}

TEST(RunPlot, TornAndForeignLinesAreLeftOut) {
  const auto samples = SamplesOfReports(
      "{\"time\":1,\"motion_forces\":[]}\nnot json\n{\"time\":2,\"motion_forces\":[[1,2,3,4]]}\n"
      "{\"time\":3,\"motion_for",
      PulledScene());
  ASSERT_TRUE(samples.ok()) << samples.status();
  EXPECT_EQ(samples->size(), 1u);
  EXPECT_FALSE(SamplesOfReports("", PulledScene()).ok());
}

TEST(RunPlot, NothingPulledHasNoForce) {
  EXPECT_EQ(FarthestPull({}).motion, -1);
  EXPECT_EQ(FarthestPull(std::vector<Motion>(3)).motion, -1);
}

}  // namespace
}  // namespace cleave
