#include <cstdint>
#include <string>
#include <vector>

#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "gtest/gtest.h"
#include "tbb/task_arena.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

constexpr int64_t kFrames = 16;

std::vector<std::string> EncodeAll(const std::vector<Vec3>& rest, std::string& header) {
  FrameEncoder encoder = MakeEncoder(Parameters(100, 1e-4, 6), rest);
  header = encoder.header_bytes();
  std::vector<std::string> frames;
  for (int64_t number = 0; number < kFrames; ++number) {
    frames.push_back(encoder.Encode(SwingingFrame(rest, number, 100))->bytes);
  }
  return frames;
}

TEST(Resume, AnEncoderGoesOnFromADecodersStateWithTheSameBytes) {
  const std::vector<Vec3> rest = RandomBody(230);
  std::string header;
  const std::vector<std::string> frames = EncodeAll(rest, header);
  for (size_t broken_after = 0; broken_after < frames.size(); ++broken_after) {
    FrameDecoder decoder = MakeDecoder(header, rest);
    // As after a restart: only from the newest key frame on.
    for (size_t at = broken_after / 6 * 6; at <= broken_after; ++at) {
      ASSERT_TRUE(decoder.Apply(frames[at]).ok());
    }
    auto encoder = FrameEncoder::Create(decoder.header(), rest, decoder.state());
    ASSERT_TRUE(encoder.ok()) << encoder.status();
    for (size_t at = broken_after + 1; at < frames.size(); ++at) {
      const auto encoded = encoder->Encode(SwingingFrame(rest, static_cast<int64_t>(at), 100));
      ASSERT_TRUE(encoded.ok()) << encoded.status();
      EXPECT_EQ(encoded->bytes, frames[at]) << "frame " << at << " after " << broken_after;
    }
  }
}

TEST(Resume, AStateOfAnotherMeshIsRefused) {
  const std::vector<Vec3> rest = RandomBody(230);
  FrameEncoder encoder = MakeEncoder(Parameters(100, 1e-4, 6), rest);
  ASSERT_TRUE(encoder.Encode(SwingingFrame(rest, 0, 100)).ok());
  const std::vector<Vec3> other = RandomBody(231);
  const auto header = MakeStreamHeader(Parameters(100, 1e-4, 6), other);
  EXPECT_EQ(FrameEncoder::Create(*header, other, encoder.state()).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(Resume, BytesAreTheSameForAnyNumberOfThreads) {
  const std::vector<Vec3> rest = RandomBody(12000);
  std::vector<std::string> expected;
  for (const int threads : {1, 2, 8}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      std::string header;
      const std::vector<std::string> frames = EncodeAll(rest, header);
      FrameDecoder decoder = MakeDecoder(header, rest);
      for (const std::string& frame : frames) ASSERT_TRUE(decoder.Apply(frame).ok());
      if (expected.empty()) expected = frames;
      EXPECT_EQ(frames, expected) << threads;
    });
  }
}

TEST(Resume, ANewEpochOrToleranceStartsWithAKeyFrame) {
  const std::vector<Vec3> rest = RandomBody(230);
  FrameEncoder encoder = MakeEncoder(Parameters(100, 1e-3, 100), rest);
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), rest);
  const auto next = [&](int64_t number) {
    const Frame frame = SwingingFrame(rest, number, 100);
    const auto encoded = encoder.Encode(frame);
    EXPECT_TRUE(encoded.ok()) << encoded.status();
    EXPECT_TRUE(decoder.Apply(encoded->bytes).ok());
    EXPECT_LE(WorstErrors(frame, decoder.frame()).as_float, encoded->header.tolerance);
    EXPECT_EQ(decoder.frame().broken_edges, frame.broken_edges);
    return encoded->header.kind;
  };
  EXPECT_EQ(next(8), FrameKind::kKey);
  EXPECT_EQ(next(20), FrameKind::kDelta);
  ASSERT_TRUE(encoder.StartEpoch(1).ok());  // a rewind: fewer edges are broken again
  EXPECT_EQ(next(9), FrameKind::kKey);
  EXPECT_EQ(decoder.epoch(), 1u);
  EXPECT_EQ(next(10), FrameKind::kDelta);
  ASSERT_TRUE(encoder.SetTolerance(1e-5).ok());
  EXPECT_EQ(next(11), FrameKind::kKey);
  EXPECT_EQ(next(12), FrameKind::kDelta);
  EXPECT_EQ(decoder.state().tolerance, 1e-5);
  EXPECT_EQ(next(100), FrameKind::kKey);
}

}  // namespace
}  // namespace cleave
