#include <gtest/gtest.h>

#include <vector>

#include "tests/metrics/statistics.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

// What the criterion is made of: Spearman of peak force against angle, and A(a) over that of the
// isotropic bar at 30 and 60 degrees, by smoothed normals: those of single facets scatter so much
// that the criterion's 0.6 at 60 degrees lies below what a crack exactly along the fibres has.
Metrics Compare(const Setting& setting, const std::string& kind) {
  Metrics found;
  for (const std::string angle : {"30", "60"}) {
    const Metrics iso = MustMeasure("fibre_bar", setting, "iso" + angle);
    const Metrics fibre = MustMeasure("fibre_bar", setting, kind + angle);
    if (iso.empty() || fibre.empty()) continue;
    found["ratio" + angle] = fibre.at("fibre_crossing_smooth") / iso.at("fibre_crossing_smooth");
    found["rough_ratio" + angle] = fibre.at("fibre_crossing") / iso.at("fibre_crossing");
    found["peak" + angle] = fibre.at("peak_force");
  }
  return found;
}

double PeakOrder(const Setting& setting, const Metrics& found) {
  const double at0 = MustMeasure("fibre_bar", setting, "fibre0")["peak_force"];
  const double at90 = MustMeasure("fibre_bar", setting, "fibre90")["peak_force"];
  return Spearman(std::vector<double>{0, 30, 60, 90},
                  std::vector<double>{at0, found.at("peak30"), found.at("peak60"), at90});
}

TEST(FibreBar, StrengthFallsWithTheAngleAndCracksFollowFibres) {
  const Setting setting{.seed = 1, .coarseness = 1.4};
  const Metrics fibre = Compare(setting, "fibre");
  EXPECT_LE(PeakOrder(setting, fibre), -0.9);
  EXPECT_LE(fibre.at("ratio30"), 0.6);
  EXPECT_LE(fibre.at("ratio60"), 0.6);
  // Fibres that only stiffen, three times the matrix, do not lead a crack.
  const Metrics plain = Compare(setting, "plain");
  EXPECT_GT(plain.at("ratio30"), 0.6);
  EXPECT_GT(plain.at("ratio60"), 0.6);
}

TEST(FullFibreBar, StrengthFallsWithTheAngleAndCracksFollowFibres) {
  for (const MeshLayout layout : kLayouts) {
    std::vector<double> order, at30, at60, plain30, plain60;
    for (const uint32_t seed : kReportedSeeds) {
      const Setting setting{.seed = seed, .layout = layout};
      Metrics fibre = Compare(setting, "fibre");
      fibre["order"] = PeakOrder(setting, fibre);
      Report("fibre_bar fibre", setting, fibre);
      const Metrics plain = Compare(setting, "plain");
      Report("fibre_bar plain", setting, plain);
      Report("fibre_bar stiff", setting, Compare(setting, "stiff"));
      order.push_back(fibre.at("order"));
      at30.push_back(fibre.at("ratio30"));
      at60.push_back(fibre.at("ratio60"));
      plain30.push_back(plain.at("ratio30"));
      plain60.push_back(plain.at("ratio60"));
    }
    EXPECT_LE(Median(order), -0.9);
    EXPECT_GE(CountWhere(order, [](double value) { return value <= -0.9; }), 4);
    for (const auto& ratios : {at30, at60}) {
      EXPECT_LE(Median(ratios), 0.6);
      EXPECT_GE(CountWhere(ratios, [](double ratio) { return ratio <= 0.6; }), 4);
    }
    EXPECT_GT(Median(plain30), 0.6);
    EXPECT_GT(Median(plain60), 0.6);
  }
}

}  // namespace
}  // namespace cleave
