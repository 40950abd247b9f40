#include <gtest/gtest.h>

#include <vector>

#include "tests/metrics/statistics.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

// A(a) counts by smoothed normals, as of the fibre bar and for its reason: those of single facets
// scatter so much that a crack along the fibres has about 0.3, and one across them 0.75.
bool FollowsFibres(const Metrics& found, const Metrics& iso) {
  return found.at("fibre_crossing_smooth") <= 0.7 * iso.at("fibre_crossing_smooth");
}

// Some piece hangs by a tenth of its final boundary or less.
bool Dangles(const Metrics& found) { return found.at("smallest_hold") <= 0.1; }

// At twice the cell size a quarter of the edges cross the tear.
TEST(Steak, StrandsBridgeATearAlongItsFibres) {
  const Setting setting{.seed = 1, .layout = MeshLayout::kJitteredLattice, .coarseness = 2};
  const Metrics meat = MustMeasure("steak", setting, "meat");
  const Metrics iso = MustMeasure("steak", setting, "iso");
  const Metrics turned = MustMeasure("steak", setting, "turned");
  ASSERT_FALSE(meat.empty() || iso.empty() || turned.empty());
  EXPECT_TRUE(FollowsFibres(meat, iso));
  EXPECT_GE(meat.at("bridging"), 5);
  EXPECT_TRUE(Dangles(meat));
  EXPECT_FALSE(FollowsFibres(turned, iso));
  EXPECT_LT(turned.at("bridging"), 5);
  EXPECT_LT(iso.at("bridging"), 5);
}

TEST(FullSteak, StrandsBridgeATearAlongItsFibres) {
  for (const MeshLayout layout : kLayouts) {
    std::vector<double> bridging;
    int follow = 0, bridged = 0, dangle = 0;
    for (const uint32_t seed : kReportedSeeds) {
      const Setting setting{.seed = seed, .layout = layout};
      const Metrics meat = MustMeasure("steak", setting, "meat");
      const Metrics iso = MustMeasure("steak", setting, "iso");
      const Metrics turned = MustMeasure("steak", setting, "turned");
      ASSERT_FALSE(meat.empty() || iso.empty() || turned.empty());
      Report("steak meat", setting, meat);
      Report("steak iso", setting, iso);
      Report("steak turned", setting, turned);
      follow += FollowsFibres(meat, iso) ? 1 : 0;
      bridged += meat.at("bridging") >= 20 ? 1 : 0;
      dangle += Dangles(meat) ? 1 : 0;
      bridging.push_back(meat.at("bridging"));
      EXPECT_FALSE(FollowsFibres(turned, iso));
      EXPECT_LT(turned.at("bridging"), 20);
      EXPECT_LT(iso.at("bridging"), 20);
    }
    EXPECT_GE(follow, 4);
    EXPECT_GE(bridged, 4);
    EXPECT_GE(dangle, 4);
    EXPECT_GE(Median(bridging), 20);
  }
}

}  // namespace
}  // namespace cleave
