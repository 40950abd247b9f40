#include "core/stream/frame_log.h"

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "core/base/crc32c.h"
#include "core/stream/stream_file.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

constexpr int64_t kFrames = 20;

class FrameLog : public ::testing::Test {
 protected:
  void SetUp() override {
    FrameEncoder encoder = MakeEncoder(Parameters(80, 1e-4, 6), rest_);
    header_ = encoder.header_bytes();
    file_ = header_;
    StreamFileIndex index(header_);
    for (int64_t number = 0; number < kFrames; ++number) {
      const auto encoded = encoder.Encode(SwingingFrame(rest_, number, 80));
      ASSERT_TRUE(encoded.ok()) << encoded.status();
      ASSERT_TRUE(index.Add(encoded->bytes).ok());
      last_frame_begin_ = file_.size();
      file_ += encoded->bytes;
      hashes_.push_back(encoded->header.state_hash);
    }
    frames_end_ = file_.size();
    file_ += index.Footer();
    rows_ = index.rows();
  }

  const std::vector<Vec3> rest_ = RandomBody(130);
  std::string header_;
  std::string file_;
  size_t last_frame_begin_ = 0;
  size_t frames_end_ = 0;
  std::vector<uint64_t> hashes_;
  std::vector<IndexRow> rows_;
};

bool Same(const IndexRow& a, const IndexRow& b) {
  return a.frame == b.frame && a.epoch == b.epoch && a.kind == b.kind && a.segment == b.segment &&
         a.offset == b.offset && a.length == b.length && a.time == b.time &&
         a.state_hash == b.state_hash && a.broken_edges == b.broken_edges &&
         a.fragments == b.fragments;
}

TEST_F(FrameLog, TornRowsAreCutOff) {
  std::string bytes;
  for (const IndexRow& row : rows_) AppendIndexRow(row, bytes);
  ASSERT_EQ(bytes.size(), rows_.size() * kIndexRowBytes);
  for (size_t size = 0; size <= bytes.size(); ++size) {
    const IndexPrefix prefix = ParseIndexRows(absl::string_view(bytes).substr(0, size));
    ASSERT_EQ(prefix.rows.size(), size / kIndexRowBytes);
    ASSERT_EQ(prefix.valid_bytes, prefix.rows.size() * kIndexRowBytes);
    for (size_t at = 0; at < prefix.rows.size(); ++at)
      EXPECT_TRUE(Same(prefix.rows[at], rows_[at]));
  }
  for (size_t at = 0; at < kIndexRowBytes; ++at) {
    std::string damaged = bytes;
    damaged[5 * kIndexRowBytes + at] ^= 0x10;
    EXPECT_EQ(ParseIndexRows(damaged).rows.size(), 5u) << at;
  }
}

TEST_F(FrameLog, SeekingToEveryFrameEqualsDecodingStraight) {
  const BufferAccess file(file_);
  const auto reader = StreamFileReader::Open(file);
  ASSERT_TRUE(reader.ok()) << reader.status();
  EXPECT_TRUE(reader->has_footer());
  EXPECT_EQ(reader->frames_end(), frames_end_);
  FrameDecoder wandering = MakeDecoder(header_, rest_);
  for (size_t step = 0; step < 3 * kFrames; ++step) {
    const size_t position = step * 7 % kFrames;
    FrameDecoder fresh = MakeDecoder(header_, rest_);
    ASSERT_TRUE(reader->Seek(position, fresh).ok());
    ASSERT_TRUE(reader->Seek(position, wandering).ok());
    EXPECT_EQ(fresh.state_hash(), hashes_[position]);
    EXPECT_EQ(wandering.state_hash(), hashes_[position]);
    EXPECT_EQ(wandering.frame().positions, fresh.frame().positions);
  }
  EXPECT_EQ(reader->Seek(kFrames, wandering).code(), absl::StatusCode::kOutOfRange);
}

TEST_F(FrameLog, AFileTornAtAnyByteOfItsLastFrameKeepsAllFramesBefore) {
  for (size_t size = last_frame_begin_; size < file_.size(); ++size) {
    const BufferAccess torn(absl::string_view(file_).substr(0, size));
    const auto reader = StreamFileReader::Open(torn);
    ASSERT_TRUE(reader.ok()) << reader.status();
    EXPECT_FALSE(reader->has_footer());
    const size_t whole = size < frames_end_ ? rows_.size() - 1 : rows_.size();
    ASSERT_EQ(reader->rows().size(), whole) << size;
    for (size_t at = 0; at < whole; ++at) EXPECT_TRUE(Same(reader->rows()[at], rows_[at]));
    EXPECT_EQ(reader->frames_end(), size < frames_end_ ? last_frame_begin_ : frames_end_);
  }
}

TEST_F(FrameLog, AFileTornInItsHeaderIsRefused) {
  for (size_t size = 0; size < header_.size(); ++size) {
    const BufferAccess torn(absl::string_view(file_).substr(0, size));
    EXPECT_EQ(StreamFileReader::Open(torn).status().code(), absl::StatusCode::kDataLoss) << size;
  }
}

TEST_F(FrameLog, ADamagedFooterIsRebuilt) {
  for (size_t at = frames_end_; at < file_.size(); at += 3) {
    std::string damaged = file_;
    damaged[at] ^= 0x40;
    const BufferAccess file(damaged);
    const auto reader = StreamFileReader::Open(file);
    ASSERT_TRUE(reader.ok()) << reader.status();
    EXPECT_FALSE(reader->has_footer());
    EXPECT_EQ(reader->rows().size(), rows_.size());
  }
}

TEST_F(FrameLog, AFrameThatTheIndexDoesNotNameIsRefused) {
  std::string swapped = file_;
  const IndexRow& first = rows_[7];
  swapped.replace(first.offset, first.length, std::string(first.length, 'x'));
  const BufferAccess file(swapped);
  const auto reader = StreamFileReader::Open(file);
  ASSERT_TRUE(reader.ok()) << reader.status();
  FrameDecoder decoder = MakeDecoder(header_, rest_);
  EXPECT_EQ(reader->Seek(9, decoder).code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(decoder.frame().frame, 6);  // the last good frame on the way
}

TEST_F(FrameLog, ADamagedFileShowsRightFramesOrNone) {
  // Flips bits all over; the index's own checksums are made right again, so that rows
  // may lie about where frames are.
  for (size_t at = header_.size(); at < file_.size(); at += at < frames_end_ ? 11 : 3) {
    std::string damaged = file_;
    damaged[at] ^= 0x04;
    const size_t rows_begin = frames_end_ + 16;
    const absl::string_view all = damaged;
    for (size_t row = 0; row < rows_.size(); ++row) {
      const size_t begin = rows_begin + row * kIndexRowBytes;
      const uint32_t checksum = Crc32c(all.substr(begin, kIndexRowBytes - 4));
      std::memcpy(damaged.data() + begin + kIndexRowBytes - 4, &checksum, 4);
    }
    const uint32_t checksum = Crc32c(all.substr(frames_end_, all.size() - 8 - frames_end_));
    std::memcpy(damaged.data() + damaged.size() - 8, &checksum, 4);

    const BufferAccess file(damaged);
    const auto reader = StreamFileReader::Open(file);
    ASSERT_TRUE(reader.ok()) << reader.status();
    FrameDecoder decoder = MakeDecoder(header_, rest_);
    for (size_t position = 0; position < reader->rows().size(); ++position) {
      if (!reader->Seek(position, decoder).ok()) continue;
      ASSERT_EQ(decoder.state_hash(), hashes_[static_cast<size_t>(decoder.frame().frame)]);
    }
  }
}

TEST(FindFrames, LookInTheNewestEpoch) {
  const auto row = [](int64_t frame, uint32_t epoch, FrameKind kind) {
    IndexRow out;
    out.frame = frame;
    out.epoch = epoch;
    out.kind = kind;
    return out;
  };
  const std::vector<IndexRow> rows = {row(0, 0, FrameKind::kKey),  row(1, 0, FrameKind::kDelta),
                                      row(2, 0, FrameKind::kHold), row(3, 0, FrameKind::kKey),
                                      row(2, 1, FrameKind::kKey),  row(3, 1, FrameKind::kDelta),
                                      row(5, 2, FrameKind::kDelta)};
  EXPECT_EQ(FindFrame(rows, 3), 5u);
  EXPECT_EQ(FindFrame(rows, 1), 1u);
  EXPECT_EQ(FindFrame(rows, 4), std::nullopt);
  EXPECT_EQ(FindFrameAtOrBefore(rows, 4), 5u);
  EXPECT_EQ(FindFrameAtOrBefore(rows, -1), std::nullopt);
  EXPECT_EQ(FindKeyframe(rows, 5), 4u);
  EXPECT_EQ(FindKeyframe(rows, 2), 0u);
  EXPECT_EQ(FindKeyframe(rows, 6), std::nullopt);  // its epoch has none
  EXPECT_EQ(FindKeyframe(rows, 7), std::nullopt);
}

}  // namespace
}  // namespace cleave
