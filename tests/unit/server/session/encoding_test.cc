#include "server/session/encoding.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace cleave {
namespace {

StreamHeader Kept() {
  StreamHeader kept;
  kept.tolerance = 1e-6;
  kept.bbox_max = {0.3, 0.4, 1.2};
  return kept;
}

v1::RegionOfInterest Around(const std::vector<int32_t>& nodes) {
  v1::RegionOfInterest region;
  for (const int32_t node : nodes) region.add_nodes(node);
  return region;
}

TEST(Encoding, RegionsThatGiveTheSameFramesAreOne) {
  const StreamHeader kept = Kept();
  const double inside = RungTolerance(Rung::kStandard, kept.diagonal());
  const double outside = RungTolerance(Rung::kPreview, kept.diagonal());
  v1::RegionOfInterest by_rung = Around({7, 2});
  by_rung.set_outside_rung(v1::RUNG_PREVIEW);
  const worker::v1::Encoding named = EncodingOfRegion(by_rung, inside, outside, false, kept);
  // As it is told to people, with six digits.
  v1::RegionOfInterest by_number = Around({2, 7, 2});
  by_number.set_outside_tolerance(0.0013);
  EXPECT_NE(outside, 0.0013001);
  const worker::v1::Encoding numbered = EncodingOfRegion(by_number, inside, 0.0013001, false, kept);
  EXPECT_EQ(named.SerializeAsString(), numbered.SerializeAsString());
  const Region region = *RegionOf(named);
  EXPECT_EQ(region.nodes, (std::vector<int32_t>{2, 7}));
  // No coarser than asked, and a power of two times what is inside, as frames have it.
  EXPECT_LE(region.outside_tolerance, outside - kept.tolerance);
  EXPECT_EQ(region.outside_tolerance, 8 * named.tolerance());
}

TEST(Encoding, OtherRegionsAndAccuraciesAreApart) {
  const StreamHeader kept = Kept();
  const std::string name = EncodingOfRegion(Around({2}), 1e-4, 1e-3, false, kept).name();
  EXPECT_NE(EncodingOfRegion(Around({3}), 1e-4, 1e-3, false, kept).name(), name);
  EXPECT_NE(EncodingOfRegion(Around({2}), 2e-4, 1e-3, false, kept).name(), name);
  EXPECT_NE(EncodingOfRegion(Around({2}), 1e-4, 1e-2, false, kept).name(), name);
  EXPECT_NE(EncodingOfRegion(Around({2}), 1e-4, 1e-3, true, kept).name(), name);
  v1::RegionOfInterest boxed = Around({2});
  for (int axis = 0; axis < 3; ++axis) {
    boxed.mutable_box()->add_min(0);
    boxed.mutable_box()->add_max(1);
  }
  EXPECT_NE(EncodingOfRegion(boxed, 1e-4, 1e-3, false, kept).name(), name);
}

}  // namespace
}  // namespace cleave
