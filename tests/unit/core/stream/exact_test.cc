#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/stream/exact_positions.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

StreamParameters Exact(uint64_t edges, uint32_t keyframe_interval) {
  StreamParameters parameters = Parameters(edges, 0, keyframe_interval);
  ChooseExact(parameters);
  return parameters;
}

bool SameBits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0;
}

TEST(Exact, RanksAscendWithDoublesAndLeadBackToThem) {
  const std::vector<double> ascending = {-std::numeric_limits<double>::max(),
                                         -1,
                                         -5e-324,
                                         -0.0,
                                         0.0,
                                         5e-324,
                                         1,
                                         std::nextafter(1.0, 2.0),
                                         std::numeric_limits<double>::max()};
  for (size_t at = 0; at < ascending.size(); ++at) {
    EXPECT_EQ(std::signbit(OfRank(RankOf(ascending[at]))), std::signbit(ascending[at]));
    EXPECT_EQ(OfRank(RankOf(ascending[at])), ascending[at]);
    if (at > 0) {
      EXPECT_LT(RankOf(ascending[at - 1]), RankOf(ascending[at]));
    }
  }
  EXPECT_EQ(RankOf(std::nextafter(1.0, 2.0)) - RankOf(1), 1);
}

TEST(Exact, EveryBitOfEveryFrameIsKeptAndBytesFollowFromTheState) {
  const std::vector<Vec3> rest = RandomBody(437);
  FrameEncoder encoder = MakeEncoder(Exact(900, 7), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  EXPECT_EQ(decoder.header().tolerance, 0);
  std::vector<std::string> frames;
  for (int64_t number = 0; number < 40; ++number) {
    const Frame frame = SwingingFrame(rest, number, 900);
    const auto encoded = encoder.Encode(frame);
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    frames.push_back(encoded->bytes);
    ASSERT_TRUE(decoder.Apply(frames.back()).ok()) << number;
    EXPECT_TRUE(SameBits(decoder.frame().positions, frame.positions)) << number;
    EXPECT_EQ(decoder.frame().broken_edges, frame.broken_edges);
    EXPECT_EQ(decoder.state_hash(), encoder.state().frame >= 0 ? encoded->header.state_hash : 0);
  }
  for (const int64_t target : {17, 3, 39, 0, 28}) {
    for (int64_t at = target / 7 * 7; at <= target; ++at) {
      ASSERT_TRUE(decoder.Apply(frames[static_cast<size_t>(at)]).ok()) << at;
    }
    EXPECT_TRUE(SameBits(decoder.frame().positions, SwingingFrame(rest, target, 900).positions));
    auto resumed = FrameEncoder::Create(decoder.header(), rest, decoder.state());
    ASSERT_TRUE(resumed.ok()) << resumed.status();
    for (int64_t at = target + 1; at < std::min<int64_t>(target + 3, 40); ++at) {
      EXPECT_EQ(resumed->Encode(SwingingFrame(rest, at, 900))->bytes,
                frames[static_cast<size_t>(at)]);
    }
  }
}

TEST(Exact, NothingFiniteIsTooFarTooSmallOrTooSudden) {
  const std::vector<Vec3> rest = RandomBody(50);
  FrameEncoder encoder = MakeEncoder(Exact(0, 1000), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  Frame frame;
  frame.positions = rest;
  const double most = std::numeric_limits<double>::max();
  const std::vector<double> odd = {1e300, -most, most, 5e-324, -1e-310, -0.0, 0.0, 1e9};
  for (frame.frame = 0; frame.frame < 40; ++frame.frame) {
    for (size_t node = 0; node < rest.size(); ++node) {
      for (size_t axis = 0; axis < 3; ++axis) {
        const auto turn = static_cast<size_t>(frame.frame) + 3 * node + axis;
        if (turn % 3 == 0) frame.positions[node][axis] = odd[turn * 7 % odd.size()];
      }
    }
    const auto encoded = encoder.Encode(frame);
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    ASSERT_TRUE(decoder.Apply(encoded->bytes).ok());
    EXPECT_TRUE(SameBits(decoder.frame().positions, frame.positions)) << frame.frame;
  }
  frame.positions[7][1] = std::numeric_limits<double>::infinity();
  const absl::Status status = encoder.Encode(frame).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange);
  EXPECT_NE(status.message().find("node 7"), absl::string_view::npos) << status;
}

TEST(Exact, AStillBodyCostsAtMost200BytesAFrame) {
  const std::vector<Vec3> rest = RandomBody(20000);
  StreamParameters parameters = Exact(100000, 1000);
  parameters.chunk_nodes = 16384;
  FrameEncoder encoder = MakeEncoder(parameters, rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  Frame frame;
  frame.positions = rest;
  for (frame.frame = 0; frame.frame < 4; ++frame.frame) {
    const auto encoded = encoder.Encode(frame);
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    EXPECT_LE(encoded->bytes.size(), 200u);
    EXPECT_EQ(encoded->header.kind, frame.frame == 0 ? FrameKind::kKey : FrameKind::kHold);
    ASSERT_TRUE(decoder.Apply(encoded->bytes).ok());
  }
}

TEST(Exact, AToleranceOrAStateOfAnotherKindIsRefused) {
  const std::vector<Vec3> rest = RandomBody(5);
  StreamParameters parameters = Exact(0, 10);
  parameters.tolerance = 1e-4;
  EXPECT_EQ(MakeStreamHeader(parameters, rest).status().code(), absl::StatusCode::kInvalidArgument);
  FrameEncoder exact = MakeEncoder(Exact(0, 10), rest);
  EXPECT_FALSE(exact.SetTolerance(1e-4).ok());
  FrameEncoder other = MakeEncoder(Parameters(0, 1e-4, 10), rest);
  Frame frame;
  frame.positions = rest;
  ASSERT_TRUE(exact.Encode(frame).ok());
  ASSERT_TRUE(other.Encode(frame).ok());
  const auto header = MakeStreamHeader(Exact(0, 10), rest);
  ASSERT_TRUE(header.ok());
  EXPECT_FALSE(FrameEncoder::Create(*header, rest, other.state()).ok());
  EXPECT_TRUE(FrameEncoder::Create(*header, rest, exact.state()).ok());
}

}  // namespace
}  // namespace cleave
