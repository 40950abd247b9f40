#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/base/crc32c.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_header.h"
#include "core/stream/section_coder.h"
#include "core/stream/stream_file.h"
#include "core/stream/stream_header.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;
using namespace stream_test;

template <typename T>
T Load(const std::string& bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}
template <typename T>
void Store(std::string& bytes, size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

// Makes the checksums of a changed frame right again, as an attacker would, as far as its lengths
// can be followed.
void FixChecksums(std::string& frame) {
  if (frame.size() < kFrameHeaderBytes) return;
  Store(frame, 84, Crc32c(absl::string_view(frame).substr(0, 84)));
  for (size_t at = kFrameHeaderBytes; at + kSectionHeaderBytes <= frame.size();) {
    const size_t coded = Load<uint32_t>(frame, at + 8);
    const absl::string_view all = frame;
    if (coded > frame.size() - at - kSectionHeaderBytes) break;
    Store(frame, at + 20,
          Crc32c(all.substr(at + kSectionHeaderBytes, coded), Crc32c(all.substr(at, 20))));
    at += kSectionHeaderBytes + coded;
  }
}

std::string FixHeader(std::string header) {
  Store(header, header.size() - 4, Crc32c(absl::string_view(header).substr(0, header.size() - 4)));
  return header;
}

// The ids of a stream.
struct Ids {
  uint16_t predictor;
  uint16_t coder;
};

class Damage : public ::testing::TestWithParam<Ids> {
 protected:
  StreamParameters WithIds(double tolerance) const {
    StreamParameters parameters = Parameters(body_.edges.size(), tolerance, 4);
    parameters.chunk_nodes = 16;
    parameters.predictor_id = GetParam().predictor;
    parameters.coder_id = GetParam().coder;
    return parameters;
  }
  Frame FrameOf(int64_t number) const {
    return SwingingFrame(body_.rest, number, body_.edges.size());
  }
  void SetUp() override {
    FrameEncoder encoder = MakeEncoder(WithIds(1e-3), body_.mesh());
    header_ = encoder.header_bytes();
    for (int64_t number = 0; number < 8; ++number) {
      Frame frame = FrameOf(number == 3 ? 2 : number);  // 3 holds
      frame.frame = number;
      frames_.push_back(encoder.Encode(frame)->bytes);
    }
    ASSERT_EQ(ParseFrameHeader(frames_[3])->kind, FrameKind::kHold);
  }

  FrameDecoder DecoderBefore(size_t frame) const {
    FrameDecoder decoder = MakeDecoder(header_, body_.mesh());
    for (size_t at = frame / 4 * 4; at < frame; ++at) EXPECT_TRUE(decoder.Apply(frames_[at]).ok());
    return decoder;
  }

  // Applies damaged bytes in the place of a frame. They must be refused and change nothing; only
  // with `same_allowed` they may also decode, and then to the right state.
  void ExpectHarmless(FrameDecoder& decoder, const std::string& damaged, size_t frame,
                      bool same_allowed) {
    const StreamState before = decoder.state();
    const Frame shown = decoder.frame();
    const absl::Status status = decoder.Apply(damaged);
    if (status.ok()) {
      ASSERT_TRUE(same_allowed);
      FrameDecoder right = DecoderBefore(frame);
      ASSERT_TRUE(right.Apply(frames_[frame]).ok());
      ASSERT_EQ(decoder.frame().positions, right.frame().positions);
      ASSERT_EQ(decoder.frame().broken_edges, right.frame().broken_edges);
      ASSERT_EQ(decoder.frame().time, right.frame().time);
      ASSERT_EQ(decoder.frame().fragments, right.frame().fragments);
      decoder = DecoderBefore(frame);
      return;
    }
    ASSERT_EQ(decoder.state().frame, before.frame);
    ASSERT_EQ(decoder.state().positions, before.positions);
    ASSERT_EQ(decoder.state().previous, before.previous);
    ASSERT_EQ(decoder.state().broken_edges, before.broken_edges);
    ASSERT_EQ(decoder.frame().positions, shown.positions);
  }

  const Body body_ = LatticeBody(5, 4, 2);
  std::string header_;
  std::vector<std::string> frames_;
};

TEST_P(Damage, TruncationAtEveryByteIsRefused) {
  for (const size_t frame : {0, 2, 3, 7}) {
    FrameDecoder decoder = DecoderBefore(frame);
    for (size_t size = 0; size < frames_[frame].size(); ++size) {
      ExpectHarmless(decoder, frames_[frame].substr(0, size), frame, false);
    }
    ExpectHarmless(decoder, frames_[frame] + '\0', frame, false);
    EXPECT_TRUE(decoder.Apply(frames_[frame]).ok());
  }
}

TEST_P(Damage, EveryFlippedBitIsRefused) {
  for (const size_t frame : {0, 2, 3, 7}) {
    FrameDecoder decoder = DecoderBefore(frame);
    for (size_t bit = 0; bit < 8 * frames_[frame].size(); ++bit) {
      std::string damaged = frames_[frame];
      damaged[bit / 8] ^= static_cast<char>(1 << bit % 8);
      ExpectHarmless(decoder, damaged, frame, false);
    }
    EXPECT_TRUE(decoder.Apply(frames_[frame]).ok());
  }
  for (size_t bit = 0; bit < 8 * header_.size(); ++bit) {
    std::string damaged = header_;
    damaged[bit / 8] ^= static_cast<char>(1 << bit % 8);
    EXPECT_FALSE(FrameDecoder::Create(damaged, body_.mesh()).ok()) << bit;
  }
}

TEST_P(Damage, FramesInAWrongPlaceAreRefused) {
  // What comes after frame `at` but is not frame at + 1; key frames apply anywhere.
  for (size_t at = 0; at < frames_.size(); ++at) {
    for (size_t other = 0; other < frames_.size(); ++other) {
      if (other == at + 1 || other % 4 == 0) continue;
      FrameDecoder decoder = DecoderBefore(at + 1);
      EXPECT_EQ(decoder.Apply(frames_[other]).code(), absl::StatusCode::kFailedPrecondition);
    }
  }
  FrameDecoder fresh = MakeDecoder(header_, body_.mesh());
  EXPECT_EQ(fresh.Apply(frames_[1]).code(), absl::StatusCode::kFailedPrecondition);
}

TEST_P(Damage, FramesOfAnotherEpochToleranceOrStreamAreRefused) {
  FrameDecoder decoder = DecoderBefore(2);
  std::string forged = frames_[2];
  Store<uint32_t>(forged, 72, 9);  // epoch
  FixChecksums(forged);
  EXPECT_EQ(decoder.Apply(forged).code(), absl::StatusCode::kFailedPrecondition);
  forged = frames_[2];
  Store<double>(forged, 40, 2e-3);  // tolerance
  FixChecksums(forged);
  EXPECT_EQ(decoder.Apply(forged).code(), absl::StatusCode::kFailedPrecondition);

  // The same body at another tolerance: the state hash covers the stream header.
  FrameEncoder encoder = MakeEncoder(WithIds(2e-3), body_.mesh());
  EXPECT_EQ(decoder.Apply(encoder.Encode(FrameOf(0))->bytes).code(), absl::StatusCode::kDataLoss);
}

TEST_P(Damage, ForgeriesWithRightChecksumsAreRefusedOrRight) {
  for (const size_t frame : {0, 1, 2, 3, 6, 7}) {
    FrameDecoder decoder = DecoderBefore(frame);
    const std::string& original = frames_[frame];
    for (size_t at = 0; at < original.size(); ++at) {
      for (const int change : {1, 2, 0x10, 0x80, 0xFF}) {
        std::string forged = original;
        forged[at] ^= static_cast<char>(change);
        FixChecksums(forged);
        ExpectHarmless(decoder, forged, frame, true);
        if (HasFatalFailure()) return;
      }
    }
    for (uint64_t round = 0; round < 2000; ++round) {
      std::string forged = original;
      const auto pick = [&](uint64_t salt, size_t below) {
        return static_cast<size_t>(UniformDraw(frame, RandomStream::kMeshJitter, round, salt) *
                                   static_cast<double>(below));
      };
      const size_t length = 1 + pick(0, 20);
      const size_t to = pick(1, original.size());
      const std::string& from = frames_[pick(2, frames_.size())];
      forged.replace(to, length, from.substr(pick(3, from.size()), pick(4, 2) ? length : 3));
      if (pick(5, 2) != 0 && forged.size() >= kFrameHeaderBytes) {
        Store<uint64_t>(forged, 8, forged.size());
      }
      FixChecksums(forged);
      ExpectHarmless(decoder, forged, frame, true);
      if (HasFatalFailure()) return;
    }
  }
}

TEST_P(Damage, CountsThatNobodyCouldMeanCostNothing) {
  for (const size_t at : {4u, 8u, 12u, 56u, 60u}) {  // sections, frame bytes, broken edges
    std::string forged = frames_[0];
    Store<uint32_t>(forged, at, 0xFFFFFFFF);
    FixChecksums(forged);
    FrameDecoder decoder = DecoderBefore(0);
    EXPECT_EQ(decoder.Apply(forged).code(), absl::StatusCode::kDataLoss);
  }
  for (const size_t frame : {0, 7}) {
    for (size_t at = 0; at < 20; at += 4) {  // type .. count of each section
      FrameDecoder decoder = DecoderBefore(frame);
      std::string forged = frames_[frame];
      Store<uint32_t>(forged, kFrameHeaderBytes + at, 0xFFFFFFFF);
      FixChecksums(forged);
      ExpectHarmless(decoder, forged, frame, false);
    }
  }
  for (size_t at = 96; at < 120; at += 8) {  // nodes, edges, tets
    for (const uint64_t count : {uint64_t{0xFFFFFFFF}, ~uint64_t{0}, uint64_t{1} << 31}) {
      std::string forged = header_;
      Store(forged, at, count);
      EXPECT_FALSE(FrameDecoder::Create(FixHeader(forged), body_.mesh()).ok());
    }
  }
}

TEST_P(Damage, ACompressionBombIsRefusedBeforeItGoesOff) {
  const std::string zeros(64 << 20, '\0');
  const std::string bomb = CodeParts(zeros, 1);
  ASSERT_LT(bomb.size(), 10000u);
  for (const uint32_t raw_bytes : {48u, 3u * 16 * 4, 64u << 20}) {
    std::string body;
    if (GetParam().predictor == kPredictorInterpolation) {
      const Section motion = SplitFrame(frames_[0])->sections[0];
      ASSERT_EQ(motion.type, SectionType::kMotion);
      AppendSection(motion, body);
    }
    for (uint32_t first = 0; first < 40; first += 16) {
      AppendSection({.type = SectionType::kPositions,
                     .coder = static_cast<uint8_t>(GetParam().coder),
                     .prediction = GetParam().predictor == kPredictorInterpolation
                                       ? Prediction::kInterpolation
                                       : Prediction::kRest,
                     .raw_bytes = raw_bytes,
                     .first = first,
                     .count = std::min(16u, 40 - first),
                     .coded = bomb},
                    body);
    }
    FrameHeader header = *ParseFrameHeader(frames_[0]);
    header.section_count = GetParam().predictor == kPredictorInterpolation ? 4 : 3;
    header.frame_bytes = kFrameHeaderBytes + body.size();
    std::string frame;
    AppendFrameHeader(header, frame);
    FrameDecoder decoder = MakeDecoder(header_, body_.mesh());
    EXPECT_EQ(decoder.Apply(frame + body).code(), absl::StatusCode::kDataLoss);
  }
}

TEST_P(Damage, SectionsThatAreNotKnownAreSkippedOnlyIfOptional) {
  std::string extended = frames_[1];
  const auto add = [&](uint16_t type) {
    AppendSection({.type = static_cast<SectionType>(type), .coder = 77, .coded = "later"},
                  extended);
    Store<uint32_t>(extended, 4, Load<uint32_t>(extended, 4) + 1);
    Store<uint64_t>(extended, 8, extended.size());
    FixChecksums(extended);
  };
  add(kOptionalSection | 9);
  FrameDecoder decoder = DecoderBefore(1);
  EXPECT_TRUE(decoder.Apply(extended).ok());
  add(9);
  decoder = DecoderBefore(1);
  EXPECT_EQ(decoder.Apply(extended).code(), absl::StatusCode::kUnimplemented);
  // A file may hold such frames: they are whole.
  const std::string bytes = header_ + frames_[0] + extended;
  const BufferAccess file(bytes);
  EXPECT_EQ(StreamFileReader::Open(file)->rows().size(), 2u);
}

TEST_P(Damage, StreamsOfLaterVersionsAreReadOnlyIfTheyCanBe) {
  const auto open = [this](const std::string& header) {
    return FrameDecoder::Create(FixHeader(header), body_.mesh()).status().code();
  };
  std::string later = header_;
  Store<uint16_t>(later, 6, 3);  // minor
  EXPECT_EQ(open(later), absl::StatusCode::kOk);
  later = header_;
  Store<uint16_t>(later, 4, 2);  // major
  EXPECT_EQ(open(later), absl::StatusCode::kUnimplemented);
  later = header_;
  Store<uint64_t>(later, 24, ~uint64_t{0});  // optional features
  EXPECT_EQ(open(later), absl::StatusCode::kOk);
  for (const size_t at : {16u, 120u, 122u, 124u, 126u}) {  // required features, ids
    later = header_;
    later[at] = 9;
    EXPECT_EQ(open(later), absl::StatusCode::kUnimplemented) << at;
  }
  const auto extended = [this](uint16_t type, uint32_t length) {
    std::string header = header_.substr(0, 252);
    header += std::string(8, '\0') + "extra" + std::string(4, '\0');
    Store<uint32_t>(header, 8, static_cast<uint32_t>(header.size()));
    Store(header, 252, type);
    Store(header, 256, length);
    return header;
  };
  EXPECT_EQ(open(extended(0x8001, 5)), absl::StatusCode::kOk);
  EXPECT_EQ(open(extended(1, 5)), absl::StatusCode::kUnimplemented);
  EXPECT_EQ(open(extended(0x8001, 6)), absl::StatusCode::kDataLoss);
  EXPECT_EQ(open(extended(0x8001, 0xFFFFFFFF)), absl::StatusCode::kDataLoss);
  later = header_;
  Store<double>(later, 136, std::numeric_limits<double>::quiet_NaN());  // tolerance
  EXPECT_EQ(open(later), absl::StatusCode::kInvalidArgument);
}

INSTANTIATE_TEST_SUITE_P(Ids, Damage, ::testing::Values(Ids{1, 1}, Ids{2, 1}, Ids{2, 2}),
                         [](const ::testing::TestParamInfo<Ids>& ids) {
                           return "Predictor" + std::to_string(ids.param.predictor) + "Coder" +
                                  std::to_string(ids.param.coder);
                         });

}  // namespace
}  // namespace cleave
