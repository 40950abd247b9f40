#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;
using namespace stream_test;

// Encodes and decodes the frame and holds the pair to the promise of the format.
void ExpectRoundTrip(FrameEncoder& encoder, FrameDecoder& decoder, const Frame& frame,
                     double tolerance) {
  const absl::StatusOr<EncodedFrame> encoded = encoder.Encode(frame);
  ASSERT_TRUE(encoded.ok()) << encoded.status();
  const absl::Status applied = decoder.Apply(encoded->bytes);
  ASSERT_TRUE(applied.ok()) << applied;
  const Frame& decoded = decoder.frame();
  EXPECT_EQ(decoded.frame, frame.frame);
  EXPECT_EQ(decoded.time, frame.time);
  EXPECT_EQ(decoded.fragments, frame.fragments);
  EXPECT_EQ(decoded.broken_edges, frame.broken_edges);
  ASSERT_EQ(decoded.positions.size(), frame.positions.size());
  const Errors worst = WorstErrors(frame, decoded);
  EXPECT_LE(worst.as_double, tolerance);
  EXPECT_LE(worst.as_float, tolerance);
  EXPECT_EQ(decoder.state_hash(), encoded->header.state_hash);
}

TEST(RoundTrip, EveryNodeOfEveryFrameStaysWithinTheTolerance) {
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const std::vector<Vec3> rest = RandomBody(437);
    FrameEncoder encoder = MakeEncoder(Parameters(900, tolerance, 7), rest);
    FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
    for (int64_t frame = 0; frame < 40; ++frame) {
      ExpectRoundTrip(encoder, decoder, SwingingFrame(rest, frame, 900), tolerance);
    }
    EXPECT_GT(decoder.frame().broken_edges.size(), 300u);
  }
}

}  // namespace
}  // namespace cleave
