#include "server/session/journal.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

worker::v1::JournalRecord RunRecord(int64_t until_frame, const std::string& request_id) {
  worker::v1::JournalRecord record;
  record.mutable_run()->mutable_goal()->set_until_frame(until_frame);
  record.mutable_run()->set_request_id(request_id);
  return record;
}

worker::v1::JournalRecord PauseRecord() {
  worker::v1::JournalRecord record;
  record.mutable_pause();
  return record;
}

// A journal of three records; returns its bytes and where each record ends.
std::string ThreeRecords(const std::string& path, std::vector<size_t>& ends) {
  absl::StatusOr<JournalWriter> writer = JournalWriter::Open(path, {});
  EXPECT_TRUE(writer.ok());
  for (const worker::v1::JournalRecord& record :
       {RunRecord(10, "a"), PauseRecord(), RunRecord(20, "b")}) {
    EXPECT_TRUE(writer->Append(record).ok());
    ends.push_back(ReadBytes(path).size());
  }
  return ReadBytes(path);
}

TEST(JournalTest, WhatWasAppendedIsRead) {
  TemporaryDirectory directory;
  std::vector<size_t> ends;
  ThreeRecords(directory / "journal", ends);
  const absl::StatusOr<JournalContents> contents = ReadJournal(directory / "journal");
  ASSERT_TRUE(contents.ok());
  ASSERT_EQ(contents->records.size(), 3u);
  EXPECT_EQ(contents->records[0].run().goal().until_frame(), 10);
  EXPECT_TRUE(contents->records[1].has_pause());
  EXPECT_EQ(contents->records[2].run().request_id(), "b");
  EXPECT_EQ(contents->torn_bytes, 0);
}

TEST(JournalTest, AMissingJournalIsEmpty) {
  const absl::StatusOr<JournalContents> contents = ReadJournal("/nowhere/journal");
  ASSERT_TRUE(contents.ok());
  EXPECT_TRUE(contents->records.empty());
}

TEST(JournalTest, ATailTornAtAnyByteIsCutAtTheLastWholeRecordAndWritingGoesOn) {
  TemporaryDirectory directory;
  std::vector<size_t> ends;
  const std::string bytes = ThreeRecords(directory / "journal", ends);
  for (size_t size = 0; size <= bytes.size(); ++size) {
    const std::string path = directory / "torn";
    WriteBytes(path, bytes.substr(0, size));
    const size_t whole = static_cast<size_t>(
        std::count_if(ends.begin(), ends.end(), [&](size_t end) { return end <= size; }));
    absl::StatusOr<JournalContents> contents = ReadJournal(path);
    ASSERT_TRUE(contents.ok());
    ASSERT_EQ(contents->records.size(), whole) << size;
    absl::StatusOr<JournalWriter> writer = JournalWriter::Open(path, *contents);
    ASSERT_TRUE(writer.ok());
    ASSERT_TRUE(writer->Append(RunRecord(99, "after")).ok());
    contents = ReadJournal(path);
    ASSERT_EQ(contents->records.size(), whole + 1);
    ASSERT_EQ(contents->records.back().run().request_id(), "after");
    ASSERT_EQ(contents->torn_bytes, 0);
  }
}

TEST(JournalTest, AnyFlippedBitEndsTheJournalBeforeItsRecord) {
  TemporaryDirectory directory;
  std::vector<size_t> ends;
  const std::string bytes = ThreeRecords(directory / "journal", ends);
  for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    const size_t record = static_cast<size_t>(
        std::count_if(ends.begin(), ends.end(), [&](size_t end) { return end <= bit / 8; }));
    ASSERT_EQ(ParseJournal(damaged).records.size(), record) << bit;
  }
}

TEST(JournalTest, ZerosBehindACrashAreNotRecords) {
  EXPECT_TRUE(ParseJournal(std::string(4096, '\0')).records.empty());
  EXPECT_TRUE(ParseJournal(std::string(4096, '\xff')).records.empty());
}

TEST(JournalTest, AGoalIsInForceUntilPauseEndOrFailure) {
  EXPECT_EQ(SummariseJournal({RunRecord(10, "a")}).goal->goal().until_frame(), 10);
  EXPECT_FALSE(SummariseJournal({RunRecord(10, "a"), PauseRecord()}).goal.has_value());
  worker::v1::JournalRecord ended;
  ended.mutable_run_ended()->set_frame(10);
  EXPECT_FALSE(SummariseJournal({RunRecord(10, "a"), ended}).goal.has_value());
  worker::v1::JournalRecord failed;
  failed.mutable_run_failed()->mutable_error()->set_reason("SOLVER_DIVERGED");
  const JournalState state = SummariseJournal({RunRecord(10, "a"), failed});
  EXPECT_FALSE(state.goal.has_value());
  EXPECT_EQ(state.failure->error().reason(), "SOLVER_DIVERGED");
  EXPECT_TRUE(state.run_requests.contains("a"));
  EXPECT_EQ(SummariseJournal({RunRecord(10, "a"), PauseRecord(), RunRecord(20, "b")})
                .goal->goal()
                .until_frame(),
            20);
}

}  // namespace
}  // namespace cleave
