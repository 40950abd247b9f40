#include "tests/scenes/branch.h"

#include <gtest/gtest.h>

#include "core/mesh/mesh_check.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

TEST(Branch, DryWoodSplintersDampWoodCrumbles) { ExpectCriteria("branch"); }

TEST(Branch, StubsFoldNoMesh) {
  for (const double coarseness : {1.0, 1.6, 2.2, 3.0}) {
    for (const uint32_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
      auto made = MakeBranch({.variant = "dry",
                              .seed = seed,
                              .layout = MeshLayout::kJitteredLattice,
                              .coarseness = coarseness});
      ASSERT_TRUE(made.ok()) << made.status();
      const Faults faults = CheckAndOrientMesh(made->mesh);
      EXPECT_TRUE(faults.ok() && faults.warnings().empty())
          << coarseness << ", seed " << seed << ": " << faults.ToStatus();
    }
  }
}

TEST(FullBranch, DryWoodSplintersDampWoodCrumbles) { ExpectCriteriaInFull("branch"); }

}  // namespace
}  // namespace cleave
