#include "core/stream/rungs.h"

#include <gtest/gtest.h>

#include "core/stream/stream_header.h"

namespace cleave {
namespace {

// Of a body whose diagonal is 3 m.
StreamHeader KeptAt(double tolerance) {
  StreamHeader header;
  header.bbox_min = {1, 2, 3};
  header.bbox_max = {2, 4, 5};
  header.tolerance = tolerance;
  return header;
}

TEST(RungsTest, ARungIsAShareOfTheDiagonal) {
  const std::vector<Vec3> rest = {{1, 2, 3}, {2, 4, 5}};
  StreamParameters parameters;
  parameters.mesh_sha256 = std::string(32, 'x');
  for (const Rung rung : {Rung::kPreview, Rung::kStandard, Rung::kFine}) {
    parameters.rung = rung;
    const absl::StatusOr<StreamHeader> header = MakeStreamHeader(parameters, rest);
    ASSERT_TRUE(header.ok()) << header.status();
    EXPECT_EQ(header->tolerance, RungTolerance(rung, 3));
    EXPECT_EQ(ParseRung(RungName(rung)), rung);
  }
  EXPECT_EQ(RungTolerance(Rung::kStandard, 0), 1e-4);
  EXPECT_FALSE(ParseRung("finest").has_value());
}

TEST(RungsTest, WhatIsGivenIsNeverCoarserThanAskedNorFinerThanNeeded) {
  const StreamHeader kept = KeptAt(RungTolerance(Rung::kFine, 3));
  for (double asked = kept.tolerance; asked < 1; asked *= 1.01) {
    const absl::StatusOr<RungChoice> choice = SnapDown(asked, kept);
    ASSERT_TRUE(choice.ok()) << asked;
    EXPECT_LE(choice->tolerance, asked);
    ASSERT_TRUE(choice->rung.has_value());
    EXPECT_EQ(choice->as_kept, choice->rung == Rung::kFine);
    if (choice->rung != Rung::kPreview) {
      EXPECT_GT(10.001 * choice->tolerance, asked);
    }
    if (!choice->as_kept) {
      EXPECT_DOUBLE_EQ(ToleranceOfAnew(*choice->rung, kept) + kept.tolerance, choice->tolerance);
    }
  }
}

TEST(RungsTest, WhatIsKeptToTheBitIsGivenSoToWhoeverWantsIt) {
  const StreamHeader kept = KeptAt(0);
  const absl::StatusOr<RungChoice> exact = SnapDown(0, kept);
  ASSERT_TRUE(exact.ok());
  EXPECT_EQ(exact->rung, Rung::kLossless);
  EXPECT_TRUE(exact->as_kept);
  EXPECT_TRUE(SnapDown(1e-9, kept)->as_kept);
  EXPECT_EQ(SnapDown(Rung::kFine, kept)->rung, Rung::kFine);
  EXPECT_EQ(ToleranceOfAnew(Rung::kFine, kept), RungTolerance(Rung::kFine, 3));
}

TEST(RungsTest, FinerThanKeptIsAnError) {
  const StreamHeader kept = KeptAt(RungTolerance(Rung::kStandard, 3));
  EXPECT_TRUE(absl::IsOutOfRange(SnapDown(Rung::kFine, kept).status()));
  EXPECT_TRUE(absl::IsOutOfRange(SnapDown(0.999 * kept.tolerance, kept).status()));
  EXPECT_TRUE(SnapDown(Rung::kStandard, kept)->as_kept);
}

TEST(RungsTest, ARungThatIsHardlyCoarserThanWhatIsKeptIsNotEncodedAnew) {
  const StreamHeader kept = KeptAt(0.7 * RungTolerance(Rung::kStandard, 3));
  const absl::StatusOr<RungChoice> choice = SnapDown(Rung::kStandard, kept);
  ASSERT_TRUE(choice.ok());
  EXPECT_TRUE(choice->as_kept);
  EXPECT_FALSE(choice->rung.has_value());
  EXPECT_EQ(choice->tolerance, kept.tolerance);
}

}  // namespace
}  // namespace cleave
