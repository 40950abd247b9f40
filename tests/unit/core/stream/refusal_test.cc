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

class Refusal : public ::testing::Test {
 protected:
  // The encoder must refuse the frame with this code and go on as if it had never seen it.
  void ExpectRefused(const Frame& bad, absl::StatusCode code, const std::string& part) {
    FrameEncoder encoder = MakeEncoder(Parameters(100, 1e-4, 10), rest_);
    FrameEncoder undisturbed = MakeEncoder(Parameters(100, 1e-4, 10), rest_);
    for (int64_t number = 0; number < 6; ++number) {
      const Frame good = SwingingFrame(rest_, number, 100);
      if (number == 4) {
        const absl::Status status = encoder.Encode(bad).status();
        EXPECT_EQ(status.code(), code) << status;
        EXPECT_THAT(std::string(status.message()), HasSubstr(part));
      }
      const auto encoded = encoder.Encode(good);
      ASSERT_TRUE(encoded.ok()) << encoded.status();
      EXPECT_EQ(encoded->bytes, undisturbed.Encode(good)->bytes);
    }
  }
  Frame Good() const { return SwingingFrame(rest_, 4, 100); }

  const std::vector<Vec3> rest_ = RandomBody(150);
};

TEST_F(Refusal, CoordinatesThatDoNotFitAreNamed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value : {std::nan(""), kInfinity, -kInfinity, 1e30, -1e7}) {
    Frame bad = Good();
    bad.positions[123][1] = value;
    ExpectRefused(bad, absl::StatusCode::kOutOfRange, "POSITION_OUT_OF_RANGE: node 123");
  }
}

TEST_F(Refusal, FramesThatDoNotFollowAreNamed) {
  Frame bad = Good();
  bad.frame = 3;
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "does not follow frame 3");
  bad.frame = -1;
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "frame -1");
  bad = Good();
  bad.time = std::nan("");
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "time");
  bad = Good();
  bad.fragments = -1;
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "fragments");
  bad = Good();
  bad.positions.pop_back();
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "149 positions");
}

TEST_F(Refusal, BrokenEdgesMustAscendStayInRangeAndStayBroken) {
  Frame bad = Good();
  bad.broken_edges = {5, 5};
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "broken_edges[1] is 5");
  bad.broken_edges = {99, 100};
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "broken_edges[1] is 100");
  bad.broken_edges = {-1};
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "broken_edges[0] is -1");
  ASSERT_FALSE(SwingingFrame(rest_, 3, 100).broken_edges.empty());
  bad.broken_edges = {};
  ExpectRefused(bad, absl::StatusCode::kInvalidArgument, "no longer");
}

TEST_F(Refusal, HeadersNameEveryFieldAtFault) {
  StreamParameters bad = Parameters(100, 1e-4, 0);
  bad.mesh_sha256 = "short";
  bad.frames_per_second = std::nan("");
  const absl::Status status = MakeStreamHeader(bad, rest_).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  for (const char* field : {"mesh_sha256", "frames_per_second", "keyframe_interval"}) {
    EXPECT_THAT(std::string(status.message()), HasSubstr(field));
  }
  EXPECT_FALSE(MakeStreamHeader(Parameters(100, 1e-4, 1), {}).ok());
  for (const double tolerance : {-1.0, 1e-16, 1e-13, 1e10, std::nan("")}) {
    EXPECT_FALSE(MakeStreamHeader(Parameters(100, tolerance, 1), rest_).ok()) << tolerance;
  }
  std::vector<Vec3> rest = rest_;
  rest[7][2] = std::nan("");
  EXPECT_THAT(std::string(MakeStreamHeader(Parameters(0, 1e-4, 1), rest).status().message()),
              HasSubstr("rest_positions[7]"));
}

TEST_F(Refusal, AnAbsentToleranceIsATenThousandthOfTheDiagonal) {
  const std::vector<Vec3> rest = {{0, 0, 0}, {3, 4, 12}};
  EXPECT_DOUBLE_EQ(MakeStreamHeader(Parameters(1, 0, 1), rest)->tolerance, 13e-4);
}

TEST_F(Refusal, EpochsRise) {
  FrameEncoder encoder = MakeEncoder(Parameters(100, 1e-4, 10), rest_);
  EXPECT_FALSE(encoder.StartEpoch(0).ok());
  EXPECT_TRUE(encoder.StartEpoch(2).ok());
  EXPECT_FALSE(encoder.StartEpoch(2).ok());
  EXPECT_FALSE(encoder.SetTolerance(0).ok());
}

TEST_F(Refusal, DecodersHoldToTheirLimitsAndTheirMesh) {
  const FrameEncoder encoder = MakeEncoder(Parameters(100, 1e-4, 10), rest_);
  const std::string& header = encoder.header_bytes();
  EXPECT_EQ(FrameDecoder::Create(header, rest_, {.max_nodes = 149}).status().code(),
            absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(FrameDecoder::Create(header, rest_, {.max_edges = 99}).status().code(),
            absl::StatusCode::kResourceExhausted);
  std::vector<Vec3> other = rest_;
  other[100][0] = std::nextafter(other[100][0], 1);
  EXPECT_EQ(FrameDecoder::Create(header, other).status().code(),
            absl::StatusCode::kFailedPrecondition);
  other.pop_back();
  EXPECT_EQ(FrameDecoder::Create(header, other).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace cleave
