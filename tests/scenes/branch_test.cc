#include "tests/scenes/branch.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/mesh/mesh_check.h"
#include "tests/metrics/statistics.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

// Wood that is dry splinters; damp, it gives way at less and snaps shorter.
bool DrySplintersDampSnaps(const Metrics& dry, const Metrics& damp) {
  return damp.at("peak_force") <= 0.8 * dry.at("peak_force") && dry.at("splinter_length") >= 0.5 &&
         dry.at("splinter_length") > damp.at("splinter_length");
}

TEST(Branch, DryWoodSplintersDampWoodSnaps) {
  const Setting setting{.seed = 1, .coarseness = 2.2};
  const Metrics dry = MustMeasure("branch", setting, "dry");
  const Metrics damp = MustMeasure("branch", setting, "damp");
  ASSERT_FALSE(dry.empty() || damp.empty());
  EXPECT_TRUE(DrySplintersDampSnaps(dry, damp));
  // Without fibres there are no splinters to speak of: the crack goes straight across.
  const Metrics iso = MustMeasure("branch", setting, "dry-iso");
  ASSERT_FALSE(iso.empty());
  EXPECT_LT(iso.at("splinter_length"), 0.7 * dry.at("splinter_length"));
}

TEST(Branch, StubsFoldNoMesh) {
  for (const uint32_t seed : kReportedSeeds) {
    auto made =
        MakeBranch({.variant = "dry", .seed = seed, .layout = MeshLayout::kJitteredLattice});
    ASSERT_TRUE(made.ok()) << made.status();
    const Faults faults = CheckAndOrientMesh(made->mesh);
    EXPECT_TRUE(faults.ok() && faults.warnings().empty()) << seed << ": " << faults.ToStatus();
  }
}

TEST(FullBranch, DryWoodSplintersDampWoodSnapsAndCrumbles) {
  for (const MeshLayout layout : kLayouts) {
    std::vector<double> holds, more_pieces;
    for (const uint32_t seed : kReportedSeeds) {
      const Setting setting{.seed = seed, .layout = layout};
      const Metrics dry = MustMeasure("branch", setting, "dry");
      const Metrics damp = MustMeasure("branch", setting, "damp");
      if (dry.empty() || damp.empty()) continue;
      Report("branch dry", setting, dry);
      Report("branch damp", setting, damp);
      holds.push_back(DrySplintersDampSnaps(dry, damp) ? 1 : 0);
      more_pieces.push_back(damp.at("pieces") / dry.at("pieces"));
    }
    ASSERT_FALSE(more_pieces.empty());
    EXPECT_GE(CountWhere(holds, [](double value) { return value == 1; }), 4);
    EXPECT_GE(Median(more_pieces), 1.5);
  }
}

}  // namespace
}  // namespace cleave
