#include "client/cli/run_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "absl/strings/match.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

class RunFolderTest : public testing::Test {
 protected:
  RunFolderTest() { EXPECT_TRUE(folder_.Make().ok()); }
  const TemporaryDirectory directory_;
  const RunFolder folder_{directory_ / "run"};
};

TEST_F(RunFolderTest, EarlierRunIsFoundAgainWithItsScene) {
  EXPECT_FALSE(folder_.EarlierSession().has_value());
  v1::Scene scene;
  scene.add_gravity(-0.1);
  scene.add_materials()->set_youngs_modulus(1.0 / 3);
  ASSERT_TRUE(folder_.Begin("sessions/rod-1", scene).ok());
  EXPECT_EQ(*folder_.EarlierSession(), "sessions/rod-1");
  EXPECT_TRUE(folder_.CheckSameScene(scene).ok());
  scene.set_seed(1);
  const absl::Status other = folder_.CheckSameScene(scene);
  EXPECT_TRUE(absl::IsFailedPrecondition(other));
  EXPECT_TRUE(absl::StrContains(other.message(), "of another scene")) << other;
}

TEST_F(RunFolderTest, SceneOfAnotherToleranceIsToldFromAnotherScene) {
  v1::Scene scene;
  scene.set_seed(1);
  ASSERT_TRUE(folder_.Begin("sessions/rod-1", scene).ok());
  scene.mutable_output()->set_tolerance(1e-5);
  const absl::Status other = folder_.CheckSameScene(scene);
  EXPECT_TRUE(absl::IsFailedPrecondition(other));
  EXPECT_TRUE(absl::StrContains(other.message(), "another output or --tolerance")) << other;
}

TEST_F(RunFolderTest, ClearRemovesOnlyWhatIsItsOwn) {
  ASSERT_TRUE(folder_.Begin("sessions/rod-1", v1::Scene()).ok());
  std::filesystem::create_directories(folder_.server_data() + "/sessions");
  std::ofstream(folder_.path() + "/notes.txt") << "keep";
  ASSERT_TRUE(folder_.Clear().ok());
  EXPECT_FALSE(folder_.EarlierSession().has_value());
  EXPECT_FALSE(std::filesystem::exists(folder_.server_data()));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() + "/notes.txt"));
}

}  // namespace
}  // namespace cleave
