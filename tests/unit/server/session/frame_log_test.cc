#include "server/session/frame_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/stream/frame_decoder.h"
#include "core/stream/stream_header.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

const std::vector<Vec3> kRest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

StreamHeader Header() {
  StreamParameters parameters;
  parameters.mesh_sha256 = std::string(32, 'm');
  parameters.edge_count = 6;
  parameters.tet_count = 1;
  parameters.keyframe_interval = 3;
  return *MakeStreamHeader(parameters, kRest);
}

Frame FrameNumber(int64_t number) {
  Frame frame{number, 0.1 * static_cast<double>(number), 1, kRest, {}};
  for (Vec3& position : frame.positions) position[2] += 0.01 * static_cast<double>(number);
  return frame;
}

// Appends frames [first, last] to the log in `directory`.
void AppendFrames(const std::string& directory, int64_t first, int64_t last,
                  int64_t segment_bytes) {
  absl::StatusOr<FrameLogWriter> log = FrameLogWriter::Open(directory, segment_bytes);
  ASSERT_TRUE(log.ok()) << log.status();
  ASSERT_EQ(log->head(), first - 1);
  absl::StatusOr<FrameEncoder> encoder = FrameEncoder::Create(Header(), kRest);
  for (int64_t number = 0; number <= last; ++number) {
    const absl::StatusOr<EncodedFrame> frame = encoder->Encode(FrameNumber(number));
    ASSERT_TRUE(frame.ok());
    if (number < first) continue;
    ASSERT_TRUE(log->Append(encoder->header_bytes(), *frame).ok());
    ASSERT_EQ(log->head(), number);
  }
}

// Decodes all frames up to `head` and compares them with what went in.
void ExpectFrames(const std::string& directory, int64_t head) {
  FrameLogReader reader(directory);
  ASSERT_TRUE(reader.Refresh(1000).ok());
  ASSERT_EQ(reader.head(), head);
  absl::StatusOr<FrameDecoder> decoder = FrameDecoder::Create(*reader.ReadHeader(), kRest);
  ASSERT_TRUE(decoder.ok());
  for (const IndexRow& row : reader.Rows(0, 1000)) {
    ASSERT_TRUE(decoder->Apply(*reader.ReadFrame(row)).ok()) << row.frame;
    ASSERT_EQ(decoder->frame().frame, row.frame);
    ASSERT_NEAR(decoder->frame().positions[0][2], 0.01 * static_cast<double>(row.frame), 1e-3);
  }
}

TEST(FrameLogTest, FramesAreReadAsTheyWereAppendedAcrossSegments) {
  TemporaryDirectory directory;
  AppendFrames(directory.path(), 0, 10, /*segment_bytes=*/1);
  EXPECT_TRUE(std::filesystem::exists(directory / "00000003.clv"));
  EXPECT_FALSE(std::filesystem::exists(directory / "00000004.clv"));
  ExpectFrames(directory.path(), 10);
}

TEST(FrameLogTest, AWriterGoesOnBehindTheLastFrame) {
  TemporaryDirectory directory;
  AppendFrames(directory.path(), 0, 4, 1 << 20);
  AppendFrames(directory.path(), 5, 9, 1 << 20);
  ExpectFrames(directory.path(), 9);
}

TEST(FrameLogTest, AnIndexTornAtAnyByteLosesOnlyTornRowsAndWritingGoesOn) {
  TemporaryDirectory whole;
  AppendFrames(whole.path(), 0, 4, 1);
  const std::string index = ReadBytes(whole / "index");
  ASSERT_EQ(index.size(), 5 * kIndexRowBytes);
  for (size_t size = 0; size <= index.size(); ++size) {
    TemporaryDirectory directory;
    std::filesystem::copy(whole.path(), directory.path(), std::filesystem::copy_options::recursive);
    WriteBytes(directory / "index", index.substr(0, size));
    AppendFrames(directory.path(), static_cast<int64_t>(size / kIndexRowBytes), 6, 1);
    ExpectFrames(directory.path(), 6);
    if (HasFatalFailure()) return;
  }
}

TEST(FrameLogTest, ASegmentTornAtAnyByteLosesOnlyFramesThatAreNotWhole) {
  TemporaryDirectory whole;
  AppendFrames(whole.path(), 0, 2, 1 << 20);
  FrameLogReader reader(whole.path());
  ASSERT_TRUE(reader.Refresh(2).ok());
  const std::vector<IndexRow> rows = reader.Rows(0, 10);
  const std::string segment = ReadBytes(whole / "00000000.clv");
  for (size_t size = 0; size <= segment.size(); ++size) {
    TemporaryDirectory directory;
    std::filesystem::copy(whole.path(), directory.path(), std::filesystem::copy_options::recursive);
    WriteBytes(directory / "00000000.clv", segment.substr(0, size));
    const int64_t kept = std::count_if(rows.begin(), rows.end(), [&](const IndexRow& row) {
      return row.offset + row.length <= size;
    });
    AppendFrames(directory.path(), kept, 4, 1 << 20);
    ExpectFrames(directory.path(), 4);
    if (HasFatalFailure()) return;
  }
}

TEST(FrameLogTest, ALogThatCannotBeReadIsAnErrorAndStaysAsItIs) {
  TemporaryDirectory directory;
  AppendFrames(directory.path(), 0, 4, 1 << 20);
  const std::string segment = directory / "00000000.clv";
  const std::string aside = directory / "aside";
  std::filesystem::rename(segment, aside);
  std::filesystem::create_symlink(segment, segment);  // to itself: what opens it fails, root too
  EXPECT_FALSE(FrameLogWriter::Open(directory.path()).ok());
  EXPECT_EQ(ReadBytes(directory / "index").size(), 5 * kIndexRowBytes);
  std::filesystem::rename(aside, segment);
  AppendFrames(directory.path(), 5, 6, 1 << 20);
  ExpectFrames(directory.path(), 6);
}

TEST(FrameLogTest, AReaderKnowsNoFrameBeyondTheAnnouncedHead) {
  TemporaryDirectory directory;
  AppendFrames(directory.path(), 0, 5, 1 << 20);
  FrameLogReader reader(directory.path());
  ASSERT_TRUE(reader.Refresh(3).ok());
  EXPECT_EQ(reader.head(), 3);
  EXPECT_FALSE(reader.Find(4).has_value());
  ASSERT_TRUE(reader.Refresh(5).ok());
  EXPECT_EQ(reader.Keyframe(5)->frame, 3);
  EXPECT_EQ(reader.Keyframe(2)->frame, 0);
  EXPECT_EQ(reader.Rows(2, 2).size(), 2u);
  EXPECT_EQ(reader.Rows(2, 2)[0].frame, 2);
}

TEST(FrameLogTest, AMissingLogIsEmpty) {
  FrameLogReader reader("/nowhere");
  EXPECT_TRUE(reader.Refresh(5).ok());
  EXPECT_EQ(reader.head(), -1);
  EXPECT_TRUE(reader.Rows(0, 5).empty());
}

}  // namespace
}  // namespace cleave
