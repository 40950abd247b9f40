#include "client/io/record/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "client/io/record/recording.h"
#include "core/stream/frame_encoder.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

constexpr int kFrames = 9;

class RecorderTest : public testing::Test {
 protected:
  RecorderTest() {
    std::filesystem::remove(path_);
    for (int i = 0; i < 50; ++i) rest_.push_back({0.1 * i, 0.2 * (i % 7), 0.3 * (i % 5)});
    StreamParameters parameters;
    parameters.mesh_sha256 = std::string(32, 'm');
    parameters.edge_count = 100;
    parameters.keyframe_interval = 4;
    FrameEncoder encoder =
        FrameEncoder::Create(MakeStreamHeader(parameters, rest_).value(), rest_).value();
    header_ = encoder.header_bytes();
    for (int i = 0; i < kFrames; ++i) {
      Frame frame;
      frame.frame = i;
      frame.time = 0.5 * i;
      frame.positions = rest_;
      for (Vec3& position : frame.positions) position[0] += 0.1 * i;
      frames_.push_back(encoder.Encode(frame).value().bytes);
    }
  }

  // Records the frames from the file's last on, up to `last`.
  absl::Status Record(int last, bool finish) {
    auto recorder = Recorder::Open(path_);
    if (!recorder.ok()) return recorder.status();
    const auto held = (*recorder)->last();
    if (absl::Status status = (*recorder)->Begin(header_); !status.ok()) return status;
    for (int i = held.has_value() ? static_cast<int>(held->frame) + 1 : 0; i <= last; ++i) {
      if (absl::Status status = (*recorder)->Append(frames_[static_cast<size_t>(i)]); !status.ok())
        return status;
    }
    return finish ? (*recorder)->Finish() : absl::OkStatus();
  }
  std::string Bytes() const {
    std::ostringstream bytes;
    bytes << std::ifstream(path_, std::ios::binary).rdbuf();
    return bytes.str();
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_ / "recorder_test.clv";
  std::vector<Vec3> rest_;
  std::string header_;
  std::vector<std::string> frames_;
};

TEST_F(RecorderTest, ARecordingThatNobodyEndedSaysSo) {
  ASSERT_TRUE(Record(3, false).ok());
  const auto recording = OpenRecording(path_, rest_);
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_EQ(recording->frames.count, 4);
  EXPECT_FALSE(recording->ended);
}

TEST_F(RecorderTest, RecordedFramesPlayBackInAnyOrder) {
  ASSERT_TRUE(Record(kFrames - 1, true).ok());
  const auto recording = OpenRecording(path_, rest_);
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_EQ(recording->frames.count, kFrames);
  EXPECT_TRUE(recording->ended);
  for (const int i : {0, 3, 8, 2}) {
    const auto frame = recording->frames.read(i);
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->frame, i);
    EXPECT_NEAR(frame->positions[7][0], rest_[7][0] + 0.1 * i, recording->header.tolerance);
  }
  EXPECT_FALSE(recording->frames.read(kFrames).ok());
}

TEST_F(RecorderTest, ContinuedRecordingHasTheBytesOfAnUnbrokenOne) {
  ASSERT_TRUE(Record(kFrames - 1, true).ok());
  const std::string whole = Bytes();
  for (const bool finished : {true, false}) {
    std::filesystem::remove(path_);
    ASSERT_TRUE(Record(5, finished).ok());
    ASSERT_TRUE(Record(kFrames - 1, true).ok());
    EXPECT_EQ(Bytes(), whole);
  }
}

TEST_F(RecorderTest, TornFrameIsForgottenAndRecordedAgain) {
  ASSERT_TRUE(Record(kFrames - 1, true).ok());
  const std::string whole = Bytes();
  for (size_t cut = header_.size(); cut < whole.size(); cut += 37) {
    std::filesystem::resize_file(path_, cut);
    ASSERT_TRUE(Record(kFrames - 1, true).ok()) << cut;
    ASSERT_EQ(Bytes(), whole) << cut;
  }
}

TEST_F(RecorderTest, FilesOfOthersAreLeftAlone) {
  std::ofstream(path_) << "a letter to my aunt";
  EXPECT_TRUE(absl::IsInvalidArgument(Recorder::Open(path_).status()));
  EXPECT_EQ(Bytes(), "a letter to my aunt");
}

TEST_F(RecorderTest, FramesOfAnotherStreamAreRefused) {
  ASSERT_TRUE(Record(3, true).ok());
  header_ = header_ + "x";
  EXPECT_TRUE(absl::IsFailedPrecondition(Record(3, true)));
}

TEST_F(RecorderTest, AnotherMeshIsRefused) {
  ASSERT_TRUE(Record(3, true).ok());
  rest_[0][0] += 1;
  EXPECT_TRUE(absl::IsFailedPrecondition(OpenRecording(path_, rest_).status()));
}

}  // namespace
}  // namespace cleave
