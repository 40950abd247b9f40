#include "core/base/faults.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(Faults, ReportsEveryErrorAtOnceAndNoWarning) {
  Faults faults;
  EXPECT_TRUE(faults.ToStatus().ok());
  faults.Warning("mesh", "has slivers");
  EXPECT_TRUE(faults.ok());
  faults.Error("materials[2].poisson_ratio", "0.52 is outside [0, 0.5)");
  faults.Error("timing.frame_count", "0 is outside [1, 10000000]");
  EXPECT_EQ(faults.ToStatus(),
            absl::InvalidArgumentError("materials[2].poisson_ratio: 0.52 is outside [0, 0.5)\n"
                                       "timing.frame_count: 0 is outside [1, 10000000]"));
}

TEST(Faults, CountsWhatItDoesNotKeep) {
  Faults faults;
  for (int i = 0; i < 250; ++i) faults.Error("tets", "bad");
  EXPECT_EQ(faults.errors().size(), static_cast<size_t>(Faults::kMaxKept));
  EXPECT_EQ(faults.error_count(), 250);
  Faults outer;
  outer.Append("mesh.", faults);
  EXPECT_EQ(outer.error_count(), 250);
  EXPECT_EQ(outer.errors().front().field, "mesh.tets");
  EXPECT_NE(outer.ToStatus().message().find("and 150 more"), std::string::npos);
}

}  // namespace
}  // namespace cleave
