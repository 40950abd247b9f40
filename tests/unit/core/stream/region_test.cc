#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

constexpr double kTolerance = 1e-5;  // m

StreamParameters WithRegions(const Body& body, uint16_t coder) {
  StreamParameters parameters = Parameters(body.edges.size(), kTolerance, 8);
  parameters.predictor_id = kPredictorInterpolation;
  parameters.coder_id = coder;
  parameters.regions = true;
  return parameters;
}

bool IsLeft(const Body& body, int32_t node) {
  return body.rest[static_cast<size_t>(node)][0] < 0.55;
}

// Two halves that drift apart and shake.
Frame HalvesFrame(const Body& body, int64_t number) {
  Frame frame;
  frame.frame = number;
  frame.positions = body.rest;
  const auto t = static_cast<double>(number);
  for (size_t node = 0; node < body.rest.size(); ++node) {
    Vec3& x = frame.positions[node];
    x[0] += IsLeft(body, static_cast<int32_t>(node)) ? -0.01 * t : 0.01 * t;
    for (size_t axis = 0; axis < 3; ++axis) {
      x[axis] += 1e-4 * Random(static_cast<uint64_t>(number), node, axis);
    }
  }
  for (size_t edge = 0; edge < body.edges.size(); ++edge) {
    if (IsLeft(body, body.edges[edge][0]) != IsLeft(body, body.edges[edge][1])) {
      frame.broken_edges.push_back(static_cast<int32_t>(edge));
    }
  }
  return frame;
}

class RegionTest : public ::testing::TestWithParam<uint16_t> {
 protected:
  // Encodes and decodes; holds each node to what the decoder says of it. Gives the size.
  size_t ExpectRoundTrip(const Frame& frame) {
    const auto encoded = encoder_.Encode(frame);
    EXPECT_TRUE(encoded.ok()) << encoded.status();
    if (!encoded.ok()) return 0;
    const absl::Status applied = decoder_.Apply(encoded->bytes);
    EXPECT_TRUE(applied.ok()) << applied;
    tolerances_ = decoder_.Tolerances();
    for (size_t node = 0; node < frame.positions.size(); ++node) {
      for (size_t axis = 0; axis < 3; ++axis) {
        const double decoded = decoder_.frame().positions[node][axis];
        EXPECT_NEAR(frame.positions[node][axis], decoded, tolerances_[node]);
        EXPECT_NEAR(frame.positions[node][axis], static_cast<float>(decoded), tolerances_[node]);
      }
    }
    EXPECT_EQ(encoder_.state().shifts, decoder_.state().shifts);
    return encoded->bytes.size();
  }

  double LargestTolerance(bool left) const {
    double largest = 0;
    for (size_t node = 0; node < tolerances_.size(); ++node) {
      if (IsLeft(body_, static_cast<int32_t>(node)) != left) continue;
      largest = std::max(largest, tolerances_[node]);
    }
    return largest;
  }

  const Body body_ = LatticeBody(12, 6, 5);
  FrameEncoder encoder_ = MakeEncoder(WithRegions(body_, GetParam()), body_.mesh());
  FrameDecoder decoder_ = MakeDecoder(encoder_.header_bytes(), body_.mesh());
  std::vector<double> tolerances_;
};

TEST_P(RegionTest, PiecesInsideKeepTheToleranceAndOthersCostLess) {
  size_t all = 0;
  for (int64_t number = 0; number < 20; ++number) {
    const size_t size = ExpectRoundTrip(HalvesFrame(body_, number));
    if (number >= 4) all += size;
  }
  EXPECT_EQ(LargestTolerance(true), kTolerance);
  EXPECT_EQ(LargestTolerance(false), kTolerance);
  ASSERT_TRUE(encoder_.StartEpoch(1).ok());
  ASSERT_TRUE(encoder_.SetRegion(Region{.nodes = {0}, .outside_tolerance = 1e-3}).ok());
  size_t some = 0;
  for (int64_t number = 0; number < 20; ++number) {
    const size_t size = ExpectRoundTrip(HalvesFrame(body_, number));
    if (number >= 4) some += size;
    EXPECT_EQ(LargestTolerance(true), kTolerance);
    EXPECT_EQ(LargestTolerance(false), 64 * kTolerance);  // the power of two below 100
  }
  EXPECT_LT(some, 8 * all / 10);
}

TEST_P(RegionTest, APieceIsFineAgainAsSoonAsItIsInside) {
  Region region{.nodes = {},
                .box = std::array<Vec3, 2>{Vec3{0.7, -1, -1}, Vec3{9, 9, 9}},
                .outside_tolerance = 1e-3};
  ASSERT_TRUE(encoder_.SetRegion(region).ok());
  ExpectRoundTrip(HalvesFrame(body_, 0));
  ExpectRoundTrip(HalvesFrame(body_, 1));
  EXPECT_GT(LargestTolerance(true), kTolerance);
  EXPECT_EQ(LargestTolerance(false), kTolerance);
  region.nodes = {0};
  ASSERT_TRUE(encoder_.SetRegion(region).ok());
  ExpectRoundTrip(HalvesFrame(body_, 1 + 1));
  EXPECT_EQ(LargestTolerance(true), kTolerance);
  region.nodes.clear();
  region.box = std::array<Vec3, 2>{Vec3{7, 7, 7}, Vec3{9, 9, 9}};
  ASSERT_TRUE(encoder_.SetRegion(region).ok());
  ExpectRoundTrip(HalvesFrame(body_, 3));
  EXPECT_GT(LargestTolerance(true), kTolerance);
  EXPECT_GT(LargestTolerance(false), kTolerance);
  ASSERT_TRUE(encoder_.SetRegion(std::nullopt).ok());
  Frame still = HalvesFrame(body_, 3);
  still.frame = 4;
  ExpectRoundTrip(still);  // does not hold what is still coarse
  EXPECT_EQ(LargestTolerance(true), kTolerance);
  EXPECT_EQ(LargestTolerance(false), kTolerance);
  still.frame = 5;
  ExpectRoundTrip(still);
}

TEST_P(RegionTest, WhatRestsIsHeldAlsoWhereItIsCoarse) {
  ASSERT_TRUE(encoder_.SetRegion(Region{.nodes = {0}, .outside_tolerance = 1e-3}).ok());
  for (int64_t number = 0; number < 3; ++number) ExpectRoundTrip(HalvesFrame(body_, number));
  Frame still = HalvesFrame(body_, 2);
  for (int64_t number = 3; number < 6; ++number) {
    still.frame = number;
    EXPECT_EQ(ExpectRoundTrip(still), kFrameHeaderBytes);
    EXPECT_EQ(LargestTolerance(true), kTolerance);
    EXPECT_EQ(LargestTolerance(false), 64 * kTolerance);
  }
}

TEST_P(RegionTest, GoingOnFromAStateEqualsNoBreak) {
  const Region region{.nodes = {5}, .outside_tolerance = 1e-3};
  ASSERT_TRUE(encoder_.SetRegion(region).ok());
  std::vector<std::string> frames;
  for (int64_t number = 0; number < 12; ++number) {
    auto resumed = FrameEncoder::Create(decoder_.header(), body_.mesh(), decoder_.state());
    ASSERT_TRUE(resumed.ok()) << resumed.status();
    ASSERT_TRUE(resumed->SetRegion(region).ok());
    Frame frame = HalvesFrame(body_, number % 5 == 2 ? number - 1 : number);  // some hold
    frame.frame = number;
    const auto bytes = resumed->Encode(frame);
    ASSERT_TRUE(bytes.ok()) << bytes.status();
    ExpectRoundTrip(frame);
    EXPECT_EQ(bytes->header.state_hash, decoder_.state_hash());
    frames.push_back(bytes->bytes);
  }
  // Key frames are 0 and 8: decoding from the second gives the same as going on.
  FrameDecoder late = MakeDecoder(encoder_.header_bytes(), body_.mesh());
  for (size_t at = 8; at < frames.size(); ++at) ASSERT_TRUE(late.Apply(frames[at]).ok()) << at;
  EXPECT_EQ(late.frame().positions, decoder_.frame().positions);
  EXPECT_EQ(late.Tolerances(), decoder_.Tolerances());
  // A state of a stream without regions does not say what is coarse.
  StreamState without = decoder_.state();
  without.shifts.clear();
  EXPECT_EQ(FrameEncoder::Create(decoder_.header(), body_.mesh(), without).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST_P(RegionTest, RegionsThatCannotBeAreRefusedWithEveryFault) {
  const absl::Status status =
      encoder_.SetRegion(Region{.nodes = {0, 360},
                                .box = std::array<Vec3, 2>{Vec3{0, 1, 0}, Vec3{1, 0, 1}},
                                .outside_tolerance = kTolerance});
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  for (const char* part :
       {"nodes[1]: 360 is outside [0, 360)", "box.max: (1, 0, 1) m is outside [1, inf) along y",
        "outside_tolerance"}) {
    EXPECT_NE(status.message().find(part), absl::string_view::npos) << status;
  }
  StreamParameters parameters = WithRegions(body_, GetParam());
  parameters.regions = false;
  FrameEncoder without = MakeEncoder(parameters, body_.mesh());
  EXPECT_FALSE(without.SetRegion(Region{.nodes = {0}, .outside_tolerance = 1e-3}).ok());
  parameters.regions = true;
  parameters.predictor_id = kPredictorTemporal;
  parameters.coder_id = kCoderZstdPlanes;
  EXPECT_FALSE(MakeStreamHeader(parameters, body_.rest).ok());
}

INSTANTIATE_TEST_SUITE_P(Coders, RegionTest, ::testing::Values(kCoderZstdPlanes, kCoderContextRans),
                         [](const ::testing::TestParamInfo<uint16_t>& coder) {
                           return "Coder" + std::to_string(coder.param);
                         });

}  // namespace
}  // namespace cleave
