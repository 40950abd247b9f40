#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/event_file.h"
#include "client/io/impurity/picture_file.h"
#include "client/io/record/recorder.h"
#include "client/io/record/recording.h"
#include "core/picture/image.h"
#include "core/stream/frame_decoder.h"
#include "tests/mutation/mutate.h"
#include "tests/unit/client/io/impurity/jpeg_picture.h"
#include "tests/unit/core/stream/golden_scene.h"
#include "tests/unit/temporary_directory.h"

// Pictures, recordings and events that are damaged or forged: what a client reads beside meshes and
// scenes. Nothing may crash or hang; what is refused is refused with a reason.

namespace cleave {
namespace {

Image Drawing() {
  Image image(24, 16);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y)[0] = static_cast<uint8_t>(10 * x);
      image.at(x, y)[1] = static_cast<uint8_t>(x * y);
      image.at(x, y)[2] = static_cast<uint8_t>(y < 8 ? 0 : 255);
    }
  }
  return image;
}

uint32_t BigEndian(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<uint8_t>(bytes[at + k]);
  return value;
}

// Makes the checksums of a damaged PNG right, as far as its lengths lead.
void MakeChunksRight(std::string& png) {
  for (size_t at = 8; at + 12 <= png.size();) {
    const size_t length = BigEndian(png, at);
    if (length > png.size() - at - 12) return;
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(png.data()) + at + 4,
                            static_cast<uInt>(length + 4));
    for (size_t k = 0; k < 4; ++k)
      png[at + 8 + length + k] = static_cast<char>(sum >> (24 - 8 * k));
    at += length + 12;
  }
}

TEST(PictureMutation, DamagedPicturesAreRefusedOrHaveTheirPixels) {
  constexpr int kRounds = 2500;
  const std::vector<std::string> samples = {*EncodePng(Drawing()), Jpeg(Drawing(), false),
                                            Jpeg(Drawing(), true)};
  int pictures = 0, refused = 0;
  uint64_t seed = 0;
  for (const std::string& sample : samples) {
    for (int round = 0; round < kRounds; ++round) {
      SCOPED_TRACE(++seed);
      Dice dice(seed);
      std::string bytes = MutateBytes(sample, dice);
      if (!dice.OneIn(4)) MakeChunksRight(bytes);
      // What is larger than the sample by far is well-formed now and then, and takes long.
      if (bytes.size() >= 24 && bytes.compare(0, 4, "\x89PNG") == 0 &&
          (BigEndian(bytes, 16) > 4096 || BigEndian(bytes, 20) > 4096) && !dice.OneIn(16))
        continue;
      const auto picture = ParseChannel(bytes, static_cast<TextureChannel>(dice.Roll(5)));
      if (!picture.ok()) {
        ++refused;
        ASSERT_EQ(picture.status().code(), absl::StatusCode::kInvalidArgument);
        ASSERT_FALSE(picture.status().message().empty());
        continue;
      }
      ++pictures;
      ASSERT_GT(picture->width, 0);
      ASSERT_GT(picture->height, 0);
      ASSERT_EQ(picture->values.size(),
                static_cast<size_t>(picture->width) * static_cast<size_t>(picture->height));
      const auto grey = ParsePicture(bytes);
      ASSERT_TRUE(grey.ok()) << grey.status();
      ASSERT_EQ(grey->values.size(), picture->values.size());
    }
  }
  // Damage that always or never shows would test only one side.
  EXPECT_GT(pictures, kRounds / 25);
  EXPECT_GT(refused, kRounds / 10);
}

template <typename T>
std::vector<T> LoadAll(const std::string& path) {
  const std::string raw = ReadBytes(path);
  std::vector<T> all(raw.size() / sizeof(T));
  std::memcpy(all.data(), raw.data(), all.size() * sizeof(T));
  return all;
}

TEST(FileMutation, DamagedRecordingsAreRefusedOrReadAndCarriedOn) {
  constexpr uint64_t kRounds = 100;
  const TemporaryDirectory folder;
  const std::string path = folder / "run.clv";
  int read = 0, refused = 0, carried_on = 0;
  for (const stream_test::GoldenStream& golden : stream_test::kGoldenStreams) {
    const std::string base = std::string(stream_test::kGoldenDirectory) + golden.name;
    const std::string bytes = ReadBytes(base + ".clv");
    const auto rest = LoadAll<Vec3>(base + ".rest");
    std::vector<std::array<int32_t, 2>> edges;
    if (golden.predictor_id == kPredictorInterpolation)
      edges = LoadAll<std::array<int32_t, 2>>(base + ".edges");
    std::vector<std::array<int32_t, 4>> tets;
    if (golden.surface) tets = LoadAll<std::array<int32_t, 4>>(base + ".tets");
    for (uint64_t round = 0; round < kRounds; ++round) {
      SCOPED_TRACE(absl::StrCat(golden.name, " ", round));
      Dice dice(round);
      WriteBytes(path, MutateBytes(bytes, dice));
      const auto recording = OpenRecording(path, {rest, edges, tets});
      if (recording.ok()) {
        for (int64_t at = 0; at < recording->frames.count; ++at) {
          const auto frame = recording->frames.read(at);
          frame.ok() ? ++read : ++refused;
          if (!frame.ok()) break;
          ASSERT_EQ(frame->positions.size(), rest.size());
        }
      } else {
        ++refused;
        ASSERT_LT(recording.status().message().size(), 1000u);
      }
      // An interrupted run would go on with it, and leave a file that opens or is what it was.
      const std::string before = ReadBytes(path);
      auto recorder = Recorder::Open(path);
      if (!recorder.ok()) {
        ASSERT_EQ(ReadBytes(path), before);
        continue;
      }
      if ((*recorder)->last().has_value()) ++carried_on;
    }
  }
  EXPECT_GT(read, 300);
  EXPECT_GT(refused, 10);
  EXPECT_GT(carried_on, 10);
}

v1::FrameEvents Events() {
  v1::FrameEvents events;
  events.set_frame(3);
  v1::EdgeBreak& broken = *events.add_edge_breaks();
  for (const int node : {3, 8}) broken.add_nodes(node);
  for (const int piece : {0, 1}) broken.add_pieces(piece);
  for (v1::BreakPlace* place : {broken.mutable_place(), events.add_splits()->mutable_place(),
                                events.mutable_splits(0)->add_separations()->mutable_place()}) {
    place->set_time(0.5);
    for (const double coordinate : {1.0, 2.0, 3.0}) {
      place->add_rest(coordinate);
      place->add_position(coordinate);
    }
  }
  return events;
}

TEST(EventMutation, ForgedEventsGiveLinesOfJson) {
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    v1::FrameEvents events = Events();
    MutateMessage(events, dice);
    const std::string lines = EventLines(events);
    for (const absl::string_view line : absl::StrSplit(lines, '\n', absl::SkipEmpty())) {
      google::protobuf::Struct parsed;
      const auto status = google::protobuf::util::JsonStringToMessage(
          google::protobuf::StringPiece(line.data(), line.size()), &parsed);
      ASSERT_TRUE(status.ok()) << status.ToString() << ": " << line;
      ASSERT_EQ(parsed.fields().count("event"), 1u);
    }
  }
}

TEST(FileMutation, DamagedEventsAreCutAtTheFirstLineThatIsNone) {
  const TemporaryDirectory folder;
  const std::string path = folder / "events.jsonl";
  std::string whole;
  for (int64_t frame = 1; frame <= 6; ++frame) {
    v1::FrameEvents events = Events();
    events.set_frame(frame);
    whole += EventLines(events);
  }
  for (uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    const std::string damaged = MutateBytes(whole, dice);
    WriteBytes(path, damaged);
    auto file = EventFile::Open(path, 4);
    ASSERT_TRUE(file.ok()) << file.status();
    v1::FrameEvents next = Events();
    next.set_frame(5);
    ASSERT_TRUE((*file)->Append(next).ok());
    const std::string now = ReadBytes(path);
    const std::string added = EventLines(next);
    ASSERT_GE(now.size(), added.size());
    // What is left of the old file is whole lines of its beginning.
    const std::string kept = now.substr(0, now.size() - added.size());
    ASSERT_EQ(now.substr(kept.size()), added);
    ASSERT_EQ(kept, damaged.substr(0, kept.size()));
    ASSERT_TRUE(kept.empty() || kept.back() == '\n');
  }
}

}  // namespace
}  // namespace cleave
