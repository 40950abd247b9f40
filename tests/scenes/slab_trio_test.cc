#include <gtest/gtest.h>

#include <vector>

#include "tests/metrics/statistics.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

bool IsoBreaksAtThePulledEnd(const Metrics& iso) {
  return iso.at("center_from_pulled") <= 0.2 && iso.at("trace_thickness") <= 0.1 &&
         iso.at("trace_angle") >= 40 && iso.at("strain_to_crack") <= 3;
}
bool AnisoFollowsItsFibres(const Metrics& aniso) { return aniso.at("trace_angle") <= 20; }

TEST(SlabTrio, EachBodyBreaksItsOwnWay) {
  const Setting setting{.seed = 1, .coarseness = 2};
  const Metrics iso = MustMeasure("slab_trio", setting, "iso");
  ASSERT_FALSE(iso.empty());
  EXPECT_TRUE(IsoBreaksAtThePulledEnd(iso));
  EXPECT_LT(iso.at("lift"), 1.25);
  const Metrics aniso = MustMeasure("slab_trio", setting, "aniso");
  ASSERT_FALSE(aniso.empty());
  EXPECT_TRUE(AnisoFollowsItsFibres(aniso));
  EXPECT_FALSE(AnisoFollowsItsFibres(MustMeasure("slab_trio", setting, "turned")));
  const Metrics impure = MustMeasure("slab_trio", setting, "impure");
  ASSERT_FALSE(impure.empty());
  EXPECT_GE(impure.at("lift"), 3);
  EXPECT_GE(impure.at("pieces"), 1.5 * iso.at("pieces"));
  EXPECT_GE(impure.at("pieces"), 1.5 * aniso.at("pieces"));
  EXPECT_LT(MustMeasure("slab_trio", setting, "shuffled").at("lift"), 3);
}

TEST(FullSlabTrio, EachBodyBreaksItsOwnWay) {
  for (const MeshLayout layout : kLayouts) {
    std::vector<double> iso_holds, aniso_holds, lifts, shuffled_lifts, pieces, other_pieces;
    for (const uint32_t seed : kReportedSeeds) {
      const Setting setting{.seed = seed, .layout = layout};
      const Metrics iso = MustMeasure("slab_trio", setting, "iso");
      const Metrics aniso = MustMeasure("slab_trio", setting, "aniso");
      const Metrics impure = MustMeasure("slab_trio", setting, "impure");
      const Metrics shuffled = MustMeasure("slab_trio", setting, "shuffled");
      ASSERT_FALSE(iso.empty() || aniso.empty() || impure.empty() || shuffled.empty());
      Report("slab_trio iso", setting, iso);
      Report("slab_trio aniso", setting, aniso);
      Report("slab_trio impure", setting, impure);
      Report("slab_trio shuffled", setting, shuffled);
      iso_holds.push_back(IsoBreaksAtThePulledEnd(iso) ? 1 : 0);
      aniso_holds.push_back(AnisoFollowsItsFibres(aniso) ? 1 : 0);
      lifts.push_back(impure.at("lift"));
      shuffled_lifts.push_back(shuffled.at("lift"));
      pieces.push_back(impure.at("pieces"));
      other_pieces.push_back(std::max(iso.at("pieces"), aniso.at("pieces")));
    }
    const auto holds = [](double value) { return value == 1; };
    EXPECT_GE(CountWhere(iso_holds, holds), 4);
    EXPECT_GE(CountWhere(aniso_holds, holds), 4);
    EXPECT_GE(Median(lifts), 3);
    EXPECT_LT(Median(shuffled_lifts), 3);
    EXPECT_GE(Median(pieces), 1.5 * Median(other_pieces));
  }
}

}  // namespace
}  // namespace cleave
