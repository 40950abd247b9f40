#include "server/gateway/frame_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace cleave {
namespace {

std::vector<std::string> FaultsOfBox(const Vec3& low, const Vec3& high) {
  v1::StreamFramesRequest request;
  v1::BoxSelector& box = *request.mutable_region()->mutable_box();
  box.mutable_min()->Add(low.begin(), low.end());
  box.mutable_max()->Add(high.begin(), high.end());
  Faults faults;
  CheckFrameChoice(request, faults);
  std::vector<std::string> lines;
  for (const Fault& fault : faults.errors())
    lines.push_back(fault.field + ": " + fault.description);
  return lines;
}

TEST(FrameChoice, ABoxThatHoldsNothingIsToldOnceForAllAxes) {
  EXPECT_THAT(FaultsOfBox({0, 0, 0}, {1, 0, 1}), testing::IsEmpty());
  EXPECT_THAT(FaultsOfBox({1, 0, 2}, {0, 1, -1}),
              testing::ElementsAre("region.box.max: (0, 1, -1) m is outside [1, inf) along x, "
                                   "[2, inf) along z, where region.box.min begins"));
  EXPECT_THAT(FaultsOfBox({0, 0, 0}, {1, std::numeric_limits<double>::quiet_NaN(), 1}),
              testing::ElementsAre(testing::HasSubstr("is outside [0, inf) along y,")));
}

}  // namespace
}  // namespace cleave
