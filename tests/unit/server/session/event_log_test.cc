#include "server/session/event_log.h"

#include <gtest/gtest.h>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

v1::FrameEvents EventsOf(int64_t frame) {
  v1::FrameEvents events;
  events.set_frame(frame);
  for (int32_t edge = 0; edge < frame; ++edge) events.add_edge_breaks()->set_edge(edge);
  return events;
}

void WriteFrames(const std::string& path, std::initializer_list<int64_t> frames) {
  absl::StatusOr<EventLogWriter> log = EventLogWriter::Open(path, 1000);
  ASSERT_TRUE(log.ok());
  for (const int64_t frame : frames) ASSERT_TRUE(log->Append(EventsOf(frame)).ok());
}

TEST(EventLogTest, FramesHaveTheirEventsAndOthersNone) {
  TemporaryDirectory directory;
  EventLogReader early(directory / "events");
  EXPECT_FALSE((*early.Read(1)).has_value());
  WriteFrames(directory / "events", {2, 5, 6});
  for (int64_t frame = 1; frame < 8; ++frame) {
    const auto events = early.Read(frame);
    ASSERT_TRUE(events.ok());
    ASSERT_EQ(events->has_value(), frame == 2 || frame == 5 || frame == 6) << frame;
    if (events->has_value()) {
      EXPECT_EQ((*events)->edge_breaks_size(), frame);
    }
  }
  // A reader of later frames passes by earlier ones.
  EventLogReader late(directory / "events");
  EXPECT_EQ((**late.Read(6)).frame(), 6);
}

TEST(EventLogTest, FramesAfterTheHeadAreCutAndWrittenAgain) {
  TemporaryDirectory directory;
  WriteFrames(directory / "events", {2, 5, 6});
  absl::StatusOr<EventLogWriter> log = EventLogWriter::Open(directory / "events", 5);
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(log->last_frame(), 5);
  ASSERT_TRUE(log->Append(EventsOf(7)).ok());
  EventLogReader reader(directory / "events");
  EXPECT_FALSE((*reader.Read(6)).has_value());
  EXPECT_TRUE((*reader.Read(7)).has_value());
}

TEST(EventLogTest, AFileTornAtAnyByteKeepsItsWholeRecords) {
  TemporaryDirectory directory;
  WriteFrames(directory / "events", {1, 2, 3});
  const std::string bytes = ReadBytes(directory / "events");
  int64_t kept = -1;
  for (size_t size = 0; size <= bytes.size(); ++size) {
    WriteBytes(directory / "events", bytes.substr(0, size));
    absl::StatusOr<EventLogWriter> log = EventLogWriter::Open(directory / "events", 100);
    ASSERT_TRUE(log.ok());
    ASSERT_GE(log->last_frame(), kept);
    kept = log->last_frame();
    ASSERT_EQ(bytes.substr(0, ReadBytes(directory / "events").size()),
              ReadBytes(directory / "events"));
  }
  EXPECT_EQ(kept, 3);
}

TEST(EventLogTest, DamageIsFoundAtEveryByteOfARecord) {
  TemporaryDirectory directory;
  WriteFrames(directory / "events", {3});
  const std::string bytes = ReadBytes(directory / "events");
  for (size_t at = 12; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    WriteBytes(directory / "events", damaged);
    EventLogReader reader(directory / "events");
    EXPECT_EQ(reader.Read(3).status().code(), absl::StatusCode::kDataLoss) << at;
    EXPECT_EQ(EventLogWriter::Open(directory / "events", 9).status().code(),
              absl::StatusCode::kDataLoss)
        << at;
    EXPECT_EQ(EventLogWriter::Open(directory / "events", 2)->last_frame(), -1) << at;
    WriteBytes(directory / "events", bytes);
  }
}

}  // namespace
}  // namespace cleave
