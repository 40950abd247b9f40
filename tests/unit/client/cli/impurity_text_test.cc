#include "client/cli/impurity_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cleave {
namespace {

using ::testing::HasSubstr;

TEST(ImpurityText, TellsTheLeastPotencyAlsoWhereNoNodeIsPure) {
  v1::PreviewImpurityResponse preview;
  EXPECT_THAT(ImpurityText(preview, true), HasSubstr("nodes: 0, 0 of them impure"));
  for (const double potency : {3.0, 2.0, 5.0}) preview.add_potencies(potency);
  EXPECT_THAT(ImpurityText(preview, true), HasSubstr("3 of them impure; potency 2 to 5\n"));
  preview.add_potencies(-1);  // upgradation
  preview.add_potencies(0);
  EXPECT_THAT(ImpurityText(preview, true), HasSubstr("4 of them impure; potency -1 to 5\n"));
}

}  // namespace
}  // namespace cleave
