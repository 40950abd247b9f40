#include "tests/scenes/branch.h"

#include <gtest/gtest.h>

#include "core/mesh/mesh_check.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Branch, DryWoodSplintersDampWoodSnaps) {
  ExpectCriteria("branch", {.seed = 1, .coarseness = 2.2});
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

TEST(FullBranch, DryWoodSplintersDampWoodSnapsAndCrumbles) { ExpectCriteriaInFull("branch"); }

}  // namespace
}  // namespace cleave
