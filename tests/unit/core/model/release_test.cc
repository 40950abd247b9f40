#include "core/model/release.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(Release, ComesWithItsTimeAndNotBefore) {
  const ReleaseRule rule{{.time = 0.5}, {}};
  const FractureProgress progress{1, 9, {0, 1}};
  EXPECT_FALSE(IsDue(rule, 0.4999, progress));
  EXPECT_TRUE(IsDue(rule, 0.5, progress));
}

TEST(Release, ComesWithTheFirstFractureOrAShareOfIt) {
  const ReleaseRule first{{.first_fracture = true}, {}};
  EXPECT_FALSE(IsDue(first, 100, {0, 2, {}}));
  EXPECT_TRUE(IsDue(first, 0, {1e-9, 1, {}}));
  const ReleaseRule share{{.broken_share = 0.25}, {}};
  EXPECT_FALSE(IsDue(share, 100, {0.2499, 5, {}}));
  EXPECT_TRUE(IsDue(share, 0, {0.25, 1, {}}));
}

TEST(Release, ComesWithSoManyPieces) {
  const ReleaseRule rule{{.pieces = 3}, {}};
  EXPECT_FALSE(IsDue(rule, 100, {0.5, 2, {}}));
  EXPECT_TRUE(IsDue(rule, 0, {0, 3, {}}));
}

TEST(Release, ComesWhenNoPieceHoldsNodesOfTwoSets) {
  const ReleaseRule rule{{}, {{0, 1}, {2}, {3}}};
  EXPECT_TRUE(IsDue(rule, 0, {0, 3, {0, 0, 1, 2}}));
  EXPECT_TRUE(IsDue(rule, 0, {0, 4, {0, 3, 1, 2}}));  // a set may lie in several pieces
  EXPECT_FALSE(IsDue(rule, 0, {0, 3, {0, 1, 1, 2}}));
  EXPECT_FALSE(IsDue(rule, 0, {0, 2, {0, 0, 1, 1}}));
  EXPECT_TRUE(IsDue(rule, 0, {0, 2, {0, -1, 1, -1}}));  // nodes of no tet are nowhere
}

TEST(Release, ComesWithTheFirstOfItsConditions) {
  const ReleaseRule rule{{.time = 1, .pieces = 2}, {}};
  EXPECT_FALSE(IsDue(rule, 0.5, {0, 1, {}}));
  EXPECT_TRUE(IsDue(rule, 0.5, {0, 2, {}}));
  EXPECT_TRUE(IsDue(rule, 1, {0, 1, {}}));
}

}  // namespace
}  // namespace cleave
