#include "client/cli/event_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

v1::FrameEvents SplitAt(int64_t frame) {
  v1::FrameEvents events;
  events.set_frame(frame);
  v1::EdgeBreak& broken = *events.add_edge_breaks();
  broken.set_edge(17);
  broken.add_nodes(3);
  broken.add_nodes(8);
  broken.add_pieces(0);
  broken.add_pieces(1);
  for (v1::BreakPlace* place : {broken.mutable_place(), events.add_splits()->mutable_place(),
                                events.mutable_splits(0)->add_separations()->mutable_place()}) {
    place->set_time(0.5);
    for (const double coordinate : {1.0, 2.0, 3.0}) place->add_rest(coordinate);
    for (const double coordinate : {1.5, 2.0, 3.0}) place->add_position(coordinate);
    place->set_energy(0.25);
  }
  v1::Piece& part = *events.mutable_splits(0)->mutable_separations(0)->mutable_part();
  part.set_piece(1);
  part.set_first_node(8);
  part.set_node_count(2);
  part.set_volume(0.125);
  return events;
}

std::string ContentOf(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class EventFileTest : public ::testing::Test {
 protected:
  const TemporaryDirectory directory_;
  const std::string path_ = directory_ / "events.jsonl";
};

TEST_F(EventFileTest, ALineAnEventWithItsPlaceAndEnergy) {
  const std::string place = R"("rest":[1,2,3],"position":[1.5,2,3],"energy":0.25})";
  EXPECT_EQ(
      EventLines(SplitAt(4)),
      R"({"frame":4,"event":"edge_break","time":0.5,"edge":17,"nodes":[3,8],"pieces":[0,1],)" +
          place + "\n" +
          R"({"frame":4,"event":"split","time":0.5,"piece":0,"volume":0,"node_count":0,)"
          R"("first_node":0,"separated":[1],)" +
          place + "\n" +
          R"({"frame":4,"event":"separation","time":0.5,"piece":1,"from":0,"volume":0.125,)"
          R"("node_count":2,"first_node":8,)" +
          place + "\n");
  EXPECT_EQ(EventLines({}), "");
}

TEST_F(EventFileTest, WhatLeadsTheRecordingIsCutWhereverItWasTorn) {
  ASSERT_TRUE((*EventFile::Open(path_, -1))->Append(SplitAt(2)).ok());
  const std::string kept = ContentOf(path_);
  ASSERT_TRUE((*EventFile::Open(path_, 2))->Append(SplitAt(3)).ok());
  const std::string bytes = ContentOf(path_);
  ASSERT_EQ(bytes, kept + EventLines(SplitAt(3)));
  for (size_t size = kept.size(); size <= bytes.size(); ++size) {
    std::ofstream(path_, std::ios::binary) << bytes.substr(0, size);
    ASSERT_TRUE((*EventFile::Open(path_, 2))->Append(SplitAt(3)).ok());
    ASSERT_EQ(ContentOf(path_), bytes) << size;
  }
}

TEST_F(EventFileTest, AFolderThatIsNotThereIsAStatus) {
  EXPECT_FALSE(EventFile::Open(directory_ / "no/such/events.jsonl", -1).ok());
}

}  // namespace
}  // namespace cleave
