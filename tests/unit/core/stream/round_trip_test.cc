#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

// Encodes and decodes the frame, holds the pair to the promise of the format and gives the size.
size_t ExpectRoundTrip(FrameEncoder& encoder, FrameDecoder& decoder, const Frame& frame,
                       double tolerance) {
  const absl::StatusOr<EncodedFrame> encoded = encoder.Encode(frame);
  EXPECT_TRUE(encoded.ok()) << encoded.status();
  if (!encoded.ok()) return 0;
  const absl::Status applied = decoder.Apply(encoded->bytes);
  EXPECT_TRUE(applied.ok()) << applied;
  const Frame& decoded = decoder.frame();
  EXPECT_EQ(decoded.frame, frame.frame);
  EXPECT_EQ(decoded.time, frame.time);
  EXPECT_EQ(decoded.fragments, frame.fragments);
  EXPECT_EQ(decoded.broken_edges, frame.broken_edges);
  EXPECT_EQ(decoded.positions.size(), frame.positions.size());
  const Errors worst = WorstErrors(frame, decoded);
  EXPECT_LE(worst.as_double, tolerance);
  const double farthest = std::abs(*std::max_element(
      frame.positions.front().data(), frame.positions.front().data() + 3 * frame.positions.size(),
      [](double a, double b) { return std::abs(a) < std::abs(b); }));
  if (farthest <= decoder.header().domain_bound) {
    EXPECT_LE(worst.as_float, tolerance);
  }
  EXPECT_EQ(decoder.state_hash(), encoded->header.state_hash);
  return encoded->bytes.size();
}

TEST(RoundTrip, EveryNodeOfEveryFrameStaysWithinTheTolerance) {
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const std::vector<Vec3> rest = RandomBody(437);
    FrameEncoder encoder = MakeEncoder(Parameters(900, tolerance, 7), rest);
    FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
    EXPECT_GT(decoder.header().domain_bound, 1.0);
    for (int64_t frame = 0; frame < 40; ++frame) {
      ExpectRoundTrip(encoder, decoder, SwingingFrame(rest, frame, 900), tolerance);
    }
    EXPECT_GT(decoder.frame().broken_edges.size(), 300u);
  }
}

TEST(RoundTrip, ErrorDoesNotGrowOverTenThousandFrames) {
  const std::vector<Vec3> rest = RandomBody(20);
  FrameEncoder encoder = MakeEncoder(Parameters(50, 1e-4, 1000000), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  for (int64_t frame = 0; frame < 10000; ++frame) {
    ExpectRoundTrip(encoder, decoder, SwingingFrame(rest, frame, 50), 1e-4);
  }
}

TEST(RoundTrip, HoldsForTeleportsAndTinyNumbers) {
  const std::vector<Vec3> rest = RandomBody(50);
  FrameEncoder encoder = MakeEncoder(Parameters(10, 1e-4, 100), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  Frame frame;
  frame.positions = rest;
  for (frame.frame = 0; frame.frame < 60; ++frame.frame) {
    for (size_t node = 0; node < rest.size(); ++node) {
      const auto step = static_cast<uint64_t>(frame.frame);
      for (size_t axis = 0; axis < 3; ++axis) {
        double& x = frame.positions[node][axis];
        switch ((node + step) % 5) {
          case 0:
            x = 1e5 * Random(step, node, axis);
            break;  // farther than float32 is promised
          case 1:
            x = 5e-324 * static_cast<double>(node);
            break;
          case 2:
            x = -1e-310;
            break;
          case 3:
            x = -x;
            break;
          default:
            break;
        }
      }
    }
    ExpectRoundTrip(encoder, decoder, frame, 1e-4);
  }
}

TEST(RoundTrip, HoldsAtTheEdgeOfTheGrid) {
  const std::vector<Vec3> rest = RandomBody(3);
  FrameEncoder encoder = MakeEncoder(Parameters(0, 1e-4, 100), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  const double reach = decoder.header().step() * (kMaxQuantised - 1);
  Frame frame;
  frame.positions = rest;
  for (frame.frame = 0; frame.frame < 6; ++frame.frame) {
    for (Vec3& x : frame.positions) {
      for (size_t axis = 0; axis < 3; ++axis) {
        x[axis] = decoder.header().origin[axis] + (frame.frame % 2 == 0 ? reach : -reach);
      }
    }
    ExpectRoundTrip(encoder, decoder, frame, 1e-4);
  }
}

TEST(RoundTrip, HoldsForOneNodeAndForFlatBodies) {
  for (const size_t nodes : {size_t{1}, size_t{2}, size_t{250}}) {
    std::vector<Vec3> rest = RandomBody(nodes);
    for (Vec3& x : rest) x[2] = 0.25;
    FrameEncoder encoder = MakeEncoder(Parameters(0, 1e-4, 5), rest);
    FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
    for (int64_t frame = 0; frame < 12; ++frame) {
      ExpectRoundTrip(encoder, decoder, SwingingFrame(rest, frame, 0), 1e-4);
    }
  }
}

TEST(RoundTrip, HoldsFarFromTheOrigin) {
  std::vector<Vec3> rest = RandomBody(100);
  for (Vec3& x : rest) x[0] += 1e6;
  FrameEncoder encoder = MakeEncoder(Parameters(0, 1e-3, 5), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  EXPECT_EQ(decoder.header().domain_bound, 0);  // finer than float32 there, so not promised
  for (int64_t frame = 0; frame < 12; ++frame) {
    ExpectRoundTrip(encoder, decoder, SwingingFrame(rest, frame, 0), 1e-3);
  }
}

TEST(RoundTrip, HoldsWhenAllEdgesBreakAtOnce) {
  constexpr uint64_t kEdges = 600000;  // three sections
  const std::vector<Vec3> rest = RandomBody(200);
  FrameEncoder encoder = MakeEncoder(Parameters(kEdges, 1e-4, 3), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  Frame frame;
  frame.positions = rest;
  for (frame.frame = 0; frame.frame < 5; ++frame.frame) {
    if (frame.frame == 1) {
      frame.broken_edges.resize(kEdges);
      std::iota(frame.broken_edges.begin(), frame.broken_edges.end(), 0);
    }
    EXPECT_LT(ExpectRoundTrip(encoder, decoder, frame, 1e-4), 1000u);
  }
}

TEST(RoundTrip, AStillBodyCostsAtMost200BytesAFrame) {
  const std::vector<Vec3> rest = RandomBody(20000);
  StreamParameters parameters = Parameters(100000, 1e-4, 24);
  parameters.chunk_nodes = 16384;
  FrameEncoder encoder = MakeEncoder(parameters, rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  Frame frame;
  frame.positions = rest;
  for (frame.frame = 0; frame.frame < 50; ++frame.frame) {
    EXPECT_LE(ExpectRoundTrip(encoder, decoder, frame, 1e-4), 200u);
  }
}

TEST(RoundTrip, SteadyMotionCostsLittleMoreThanNone) {
  const std::vector<Vec3> rest = RandomBody(2000);
  FrameEncoder encoder = MakeEncoder(Parameters(100, 1e-4, 1000), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  Frame frame;
  frame.positions = rest;
  size_t bytes = 0;
  for (frame.frame = 0; frame.frame < 20; ++frame.frame) {
    for (size_t node = 0; node < rest.size(); ++node) {
      for (size_t axis = 0; axis < 3; ++axis) {
        frame.positions[node][axis] =
            rest[node][axis] * (1 + 0.01 * static_cast<double>(frame.frame));
      }
    }
    bytes = ExpectRoundTrip(encoder, decoder, frame, 1e-4);
  }
  EXPECT_LT(bytes, 2000 * 2u);  // a linear continuation leaves only rounding
}

}  // namespace
}  // namespace cleave
