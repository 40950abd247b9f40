#include <gtest/gtest.h>

#include <vector>

#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

// The shell splits before the core, at less stretch and in more places.
bool ShellSplitsFirst(const Metrics& found) {
  return found.contains("stretch_ratio") && found.at("first_bread") >= 0 &&
         found.at("first_bread") < found.at("first_meat") && found.at("stretch_ratio") >= 1.3 &&
         found.at("broken_bread") > found.at("broken_meat");
}

TEST(MeatLoaf, ItsShellSplitsBeforeItsCore) {
  const Setting setting{.seed = 1, .layout = MeshLayout::kJitteredLattice, .coarseness = 1.9};
  const Metrics loaf = MustMeasure("meat_loaf", setting, "loaf");
  const Metrics meat = MustMeasure("meat_loaf", setting, "meat");
  ASSERT_FALSE(loaf.empty() || meat.empty());
  EXPECT_TRUE(ShellSplitsFirst(loaf));
  EXPECT_GT(meat.at("broken_edges"), 0);
  EXPECT_FALSE(ShellSplitsFirst(meat));
}

TEST(FullMeatLoaf, ItsShellSplitsBeforeItsCore) {
  for (const MeshLayout layout : kLayouts) {
    int holds = 0;
    for (const uint32_t seed : kReportedSeeds) {
      const Setting setting{.seed = seed, .layout = layout};
      const Metrics loaf = MustMeasure("meat_loaf", setting, "loaf");
      const Metrics meat = MustMeasure("meat_loaf", setting, "meat");
      ASSERT_FALSE(loaf.empty() || meat.empty());
      Report("meat_loaf loaf", setting, loaf);
      Report("meat_loaf meat", setting, meat);
      holds += ShellSplitsFirst(loaf) ? 1 : 0;
      EXPECT_FALSE(ShellSplitsFirst(meat));
    }
    EXPECT_GE(holds, 4);
  }
}

}  // namespace
}  // namespace cleave
