#include "server/worker/rung_log.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "core/stream/stream_header.h"
#include "server/files/durable_file.h"
#include "server/worker/failure.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

constexpr int64_t kHead = 7;

class RungLogTest : public ::testing::Test {
 protected:
  void SetUp() override {
    inputs_.mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    inputs_.mesh.tets = {{0, 1, 2, 3}};
    ASSERT_TRUE(MakeDirectory(paths_.frames()).ok());
    ASSERT_TRUE(MakeDirectory(paths_.rungs()).ok());
    StreamParameters parameters;
    parameters.mesh_sha256 = std::string(32, 'm');
    parameters.edge_count = 6;
    parameters.tet_count = 1;
    parameters.keyframe_interval = 3;
    parameters.tolerance = 1e-6;
    header_ = *MakeStreamHeader(parameters, inputs_.mesh.rest_positions);
    auto log = FrameLogWriter::Open(paths_.frames());
    ASSERT_TRUE(log.ok()) << log.status();
    auto encoder = FrameEncoder::Create(header_, inputs_.mesh.rest_positions);
    ASSERT_TRUE(encoder.ok()) << encoder.status();
    for (int64_t number = 0; number <= kHead; ++number) {
      Frame frame{number, 0.1 * static_cast<double>(number), 1, inputs_.mesh.rest_positions, {}};
      for (Vec3& position : frame.positions) position[2] += 0.01 * static_cast<double>(number);
      const auto encoded = encoder->Encode(frame);
      ASSERT_TRUE(encoded.ok()) << encoded.status();
      ASSERT_TRUE(log->Append(encoder->header_bytes(), *encoded).ok());
    }
    encoding_ = *EncodingOfRung(Rung::kPreview, /*surface=*/false, header_);
  }

  absl::StatusOr<std::unique_ptr<RungLog>> Open() const {
    return RungLog::Open(paths_, inputs_, encoding_);
  }
  // Encodes what is left up to a frame, and returns the frame before.
  int64_t EncodeTo(int64_t last) const {
    auto log = Open();
    EXPECT_TRUE(log.ok()) << log.status();
    if (!log.ok()) return -2;
    const int64_t found = (*log)->head();
    EXPECT_TRUE((*log)->Follow(kHead).ok());
    while ((*log)->head() < last) {
      const absl::Status encoded = (*log)->EncodeNext();
      EXPECT_TRUE(encoded.ok()) << encoded;
      if (!encoded.ok()) break;
    }
    return found;
  }
  // Flips a bit of a frame in the log of a directory.
  static void Damage(const std::string& directory, int64_t frame) {
    FrameLogReader reader(directory);
    ASSERT_TRUE(reader.Refresh(kHead).ok());
    const auto row = reader.Find(frame);
    ASSERT_TRUE(row.has_value());
    std::string bytes = ReadBytes(directory + "/00000000.clv");
    bytes[row->offset + row->length - 1] ^= 1;
    WriteBytes(directory + "/00000000.clv", bytes);
  }
  std::string FileOf(const std::string& name) const {
    return paths_.rung(encoding_.name()) + "/" + name;
  }

  const TemporaryDirectory directory_;
  const SessionPaths paths_{directory_.path()};
  SessionInputs inputs_;
  StreamHeader header_;
  worker::v1::Encoding encoding_;
};

TEST_F(RungLogTest, ALogGoesOnWhereItEndsAndIsTheSameAsInOneGo) {
  EXPECT_EQ(EncodeTo(kHead), -1);
  const std::string whole = ReadBytes(FileOf("00000000.clv"));
  std::filesystem::remove_all(paths_.rung(encoding_.name()));
  EXPECT_EQ(EncodeTo(4), -1);
  EXPECT_EQ(EncodeTo(kHead), 4);
  EXPECT_EQ(ReadBytes(FileOf("00000000.clv")), whole);
}

TEST_F(RungLogTest, ADamagedLogIsBegunAnew) {
  EXPECT_EQ(EncodeTo(kHead), -1);
  const std::string whole = ReadBytes(FileOf("00000000.clv"));
  Damage(paths_.rung(encoding_.name()), 6);  // the key frame of the last one
  EXPECT_EQ(EncodeTo(kHead), -1);
  EXPECT_EQ(ReadBytes(FileOf("00000000.clv")), whole);
  std::string damaged = whole;
  damaged[10] ^= 1;  // in the header
  WriteBytes(FileOf("00000000.clv"), damaged);
  EXPECT_EQ(EncodeTo(kHead), -1);
  EXPECT_EQ(ReadBytes(FileOf("00000000.clv")), whole);
  std::filesystem::remove(FileOf("00000000.clv"));
  EXPECT_EQ(EncodeTo(kHead), -1);
  EXPECT_EQ(ReadBytes(FileOf("00000000.clv")), whole);
}

TEST_F(RungLogTest, ALogAheadOfTheSessionIsBegunAnew) {
  EXPECT_EQ(EncodeTo(kHead), -1);
  const std::string index = ReadBytes(paths_.frames() + "/index");
  WriteBytes(paths_.frames() + "/index", index.substr(0, 3 * kIndexRowBytes));
  EXPECT_EQ(EncodeTo(2), -1);
  WriteBytes(paths_.frames() + "/index", index);
  EXPECT_EQ(EncodeTo(kHead), 2);
}

TEST_F(RungLogTest, ALogThatCannotBeReadIsAnErrorAndStaysAsItIs) {
  EXPECT_EQ(EncodeTo(kHead), -1);
  const std::string segment = FileOf("00000000.clv");
  const std::string whole = ReadBytes(segment);
  const std::string aside = directory_ / "aside";
  std::filesystem::rename(segment, aside);
  std::filesystem::create_symlink(segment, segment);  // to itself: what opens it fails, root too
  EXPECT_FALSE(Open().ok());
  ASSERT_TRUE(std::filesystem::is_symlink(std::filesystem::symlink_status(segment)));
  std::filesystem::rename(aside, segment);
  EXPECT_EQ(EncodeTo(kHead), kHead);
  EXPECT_EQ(ReadBytes(segment), whole);
}

TEST_F(RungLogTest, ASessionThatCannotBeReadCostsNoRung) {
  EXPECT_EQ(EncodeTo(4), -1);
  const std::string kept = ReadBytes(paths_.frames() + "/00000000.clv");
  Damage(paths_.frames(), 4);
  EXPECT_FALSE(Open().ok());
  WriteBytes(paths_.frames() + "/00000000.clv", kept);
  EXPECT_EQ(EncodeTo(kHead), 4);
}

TEST_F(RungLogTest, FramesThatAreTornAreReportedAsADamagedSession) {
  auto log = Open();
  ASSERT_TRUE(log.ok()) << log.status();
  ASSERT_TRUE((*log)->Follow(kHead).ok());
  const std::string segment = paths_.frames() + "/00000000.clv";
  WriteBytes(segment, ReadBytes(segment).substr(0, 300));
  absl::Status torn;
  while (torn.ok() && (*log)->behind()) torn = (*log)->EncodeNext();
  const v1::Error error = FailureOf(torn);
  EXPECT_EQ(error.reason(), "SESSION_DAMAGED");
  EXPECT_EQ(error.code(), static_cast<int>(absl::StatusCode::kDataLoss));
  EXPECT_NE(error.message().find(segment + " ends at byte 300, before "), std::string::npos)
      << error.message();
  // What the encoder cannot hold is the solver's.
  EXPECT_EQ(FailureOf(absl::OutOfRangeError("POSITION_OUT_OF_RANGE")).reason(), "SOLVER_DIVERGED");
}

}  // namespace
}  // namespace cleave
