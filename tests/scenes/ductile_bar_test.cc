#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/metrics/statistics.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

constexpr double kLonger = 1.15;

// Of the alloy over gold: 0 where either did not come to it.
double Ratio(const Metrics& alloy, const Metrics& gold, const std::string& metric) {
  const double upper = alloy.at(metric), lower = gold.at(metric);
  return upper > 0 && lower > 0 ? upper / lower : 0;
}

bool AlloyStretchesFarther(const Metrics& alloy, const Metrics& gold) {
  return Ratio(alloy, gold, "elongation_at_fracture") >= kLonger &&
         Ratio(alloy, gold, "elongation_at_separation") >= kLonger &&
         alloy.at("strain_of_neck") > gold.at("strain_of_neck") &&
         alloy.at("strain_of_bar") > gold.at("strain_of_bar");
}

TEST(DuctileBar, CopperMakesGoldStretchFartherInALongerThinnerNeck) {
  const Setting setting{.seed = 1, .coarseness = 2.6};
  const Metrics gold = MustMeasure("ductile_bar", setting, "gold");
  const Metrics alloy = MustMeasure("ductile_bar", setting, "alloy");
  ASSERT_FALSE(gold.empty() || alloy.empty());
  EXPECT_TRUE(AlloyStretchesFarther(alloy, gold));
  EXPECT_LT(alloy.at("neck_area"), 0.8 * gold.at("neck_area"));
  EXPECT_GT(alloy.at("neck_length"), gold.at("neck_length"));
  // Without what the impurity does to strength there is no difference.
  const Metrics off = MustMeasure("ductile_bar", setting, "off");
  ASSERT_FALSE(off.empty());
  EXPECT_FALSE(AlloyStretchesFarther(off, gold));
  EXPECT_NEAR(Ratio(off, gold, "elongation_at_fracture"), 1, 0.02);
  EXPECT_NEAR(Ratio(off, gold, "elongation_at_separation"), 1, 0.02);
}

TEST(FullDuctileBar, CopperMakesGoldStretchFartherInALongerThinnerNeck) {
  for (const MeshLayout layout : kLayouts) {
    std::vector<double> holds, at_fracture, at_separation, off_ratio, thinner, longer;
    for (const uint32_t seed : kReportedSeeds) {
      const Setting setting{.seed = seed, .layout = layout};
      const Metrics gold = MustMeasure("ductile_bar", setting, "gold");
      const Metrics alloy = MustMeasure("ductile_bar", setting, "alloy");
      const Metrics off = MustMeasure("ductile_bar", setting, "off");
      ASSERT_FALSE(gold.empty() || alloy.empty() || off.empty());
      Report("ductile_bar gold", setting, gold);
      Report("ductile_bar alloy", setting, alloy);
      holds.push_back(AlloyStretchesFarther(alloy, gold) ? 1 : 0);
      at_fracture.push_back(Ratio(alloy, gold, "elongation_at_fracture"));
      at_separation.push_back(Ratio(alloy, gold, "elongation_at_separation"));
      for (const std::string metric : {"elongation_at_fracture", "elongation_at_separation"})
        off_ratio.push_back(Ratio(off, gold, metric));
      thinner.push_back(alloy.at("neck_area") / gold.at("neck_area"));
      longer.push_back(alloy.at("neck_length") - gold.at("neck_length"));
    }
    EXPECT_GE(CountWhere(holds, [](double value) { return value == 1; }), 4);
    EXPECT_GE(Median(at_fracture), kLonger);
    EXPECT_GE(Median(at_separation), kLonger);
    EXPECT_LT(Median(thinner), 0.8);
    EXPECT_GT(Median(longer), 0);
    for (const double ratio : off_ratio) EXPECT_NEAR(ratio, 1, 0.02);
  }
}

}  // namespace
}  // namespace cleave
