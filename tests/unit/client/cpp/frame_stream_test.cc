#include "client/cpp/frame_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "absl/synchronization/notification.h"
#include "cleave/v1/frame.grpc.pb.h"
#include "core/stream/frame_encoder.h"
#include "tests/unit/client/cpp/fake_server.h"

namespace cleave {
namespace {

constexpr int kFrames = 12;
constexpr int kNodes = 500;

std::vector<Vec3> RestPositions() {
  std::vector<Vec3> positions;
  for (int i = 0; i < kNodes; ++i) positions.push_back({0.01 * i, 0.02 * (i % 7), 0.03 * (i % 5)});
  return positions;
}

// A recorded session: its log in memory, served as the protocol says, with cuts where told.
class FakeFrames : public v1::FrameService::Service {
 public:
  FakeFrames() {
    const std::vector<Vec3> rest = RestPositions();
    StreamParameters parameters;
    parameters.mesh_sha256 = std::string(32, 'm');
    parameters.edge_count = 1000;
    parameters.keyframe_interval = 5;
    const StreamHeader header_fields = MakeStreamHeader(parameters, rest).value();
    FrameEncoder encoder = FrameEncoder::Create(header_fields, rest).value();
    header = encoder.header_bytes();
    for (int i = 0; i < kFrames; ++i) {
      Frame frame;
      frame.frame = i;
      frame.time = i / 24.0;
      frame.positions = rest;
      for (Vec3& position : frame.positions) position[2] += 0.01 * i * position[0];
      for (int edge = 0; edge < i; ++edge) frame.broken_edges.push_back(edge);
      frames.push_back(encoder.Encode(frame).value());
    }
  }

  grpc::Status StreamFrames(grpc::ServerContext*, const v1::StreamFramesRequest* request,
                            grpc::ServerWriter<v1::StreamFramesResponse>* writer) override {
    ++streams;
    if (refusals > 0) {
      --refusals;
      return grpc::Status(grpc::StatusCode::UNAVAILABLE, "restarting");
    }
    int64_t first = request->first_frame() / 5 * 5;
    const bool resumed = can_resume && request->has_resume() &&
                         frames[static_cast<size_t>(request->resume().frame())].header.state_hash ==
                             request->resume().state_hash();
    if (resumed) first = request->resume().frame() + 1;
    v1::StreamFramesResponse message;
    message.mutable_start()->set_header(header);
    message.mutable_start()->set_first_frame(first);
    message.mutable_start()->set_resumed(resumed);
    message.mutable_start()->set_mesh_asset("mesh");
    writer->Write(message);
    const int64_t last = request->has_stop_frame() ? request->stop_frame() : kFrames - 1;
    for (int64_t i = first; i <= last; ++i) {
      if (i == gap_at) {
        message.mutable_gap()->set_first_frame(gap_from == -1 ? i : gap_from);
        message.mutable_gap()->set_last_frame(gap_to - 1);
        writer->Write(message);
        if (gap_twice) writer->Write(message);
        i = gap_to;
      }
      std::string bytes = frames[static_cast<size_t>(i)].bytes;
      if (i == damaged_frame) bytes[bytes.size() / 2] ^= 1;
      for (size_t at = 0; at < bytes.size(); at += 300) {
        if (i == cut_in_frame && at > 0) {
          cut_in_frame = -1;
          return cut_status;
        }
        message.mutable_chunk()->set_frame(i);
        message.mutable_chunk()->set_offset(at);
        message.mutable_chunk()->set_frame_bytes(bytes.size());
        message.mutable_chunk()->set_payload(bytes.substr(at, 300));
        message.mutable_chunk()->set_head_frame(kFrames - 1);
        writer->Write(message);
      }
      if (i == 3 && heartbeat) {
        message.mutable_heartbeat()->set_head_frame(kFrames - 1);
        writer->Write(message);
      }
    }
    if (request->follow()) viewer_left.WaitForNotification();
    if (end_cleanly) {
      message.mutable_end()->set_last_frame(last);
      message.mutable_end()->set_reason(v1::END_REASON_GOAL_REACHED);
      writer->Write(message);
    }
    return grpc::Status::OK;
  }

  std::string header;
  std::vector<EncodedFrame> frames;
  int cut_in_frame = -1;
  grpc::Status cut_status{grpc::StatusCode::UNAVAILABLE, "cut"};
  int damaged_frame = -1;
  int64_t gap_at = -1;  // before this frame, those up to gap_to are left out, this one too
  int64_t gap_to = 10;
  int64_t gap_from = -1;  // what is told of it, where that is not gap_at
  bool gap_twice = false;
  int refusals = 0;
  bool can_resume = true;
  bool heartbeat = true;
  bool end_cleanly = true;
  absl::Notification viewer_left;  // what ends a stream that follows
  int streams = 0;
};

// All frames that the stream gives until its end or its error.
std::vector<int64_t> Drain(FrameStream& stream, absl::Status& status,
                           std::string* bytes = nullptr) {
  std::vector<int64_t> numbers;
  while (true) {
    auto frame = stream.Next();
    status = frame.status();
    if (!frame.ok() || !frame->has_value()) return numbers;
    numbers.push_back((*frame)->header.frame);
    if (bytes != nullptr) bytes->append((*frame)->bytes);
  }
}

FrameStreamOptions Options() {
  FrameStreamOptions options;
  options.session = "sessions/rod";
  return options;
}

std::vector<int64_t> Numbers(int64_t from, int64_t to) {
  std::vector<int64_t> numbers;
  for (int64_t i = from; i <= to; ++i) numbers.push_back(i);
  return numbers;
}

TEST(FrameStream, GivesEveryFrameOnceAsItIsInTheLogAndDecodesIt) {
  FakeFrames service;
  FakeServer server(service);
  FrameStreamOptions options = Options();
  options.rest_positions = RestPositions();
  FrameStream stream(server.client(), options);
  absl::Status status;
  std::string bytes, expected;
  EXPECT_EQ(Drain(stream, status, &bytes), Numbers(0, kFrames - 1));
  EXPECT_TRUE(status.ok()) << status;
  for (const EncodedFrame& frame : service.frames) expected += frame.bytes;
  EXPECT_EQ(bytes, expected);
  ASSERT_NE(stream.decoder(), nullptr);
  EXPECT_EQ(stream.decoder()->frame().frame, kFrames - 1);
  EXPECT_EQ(stream.decoder()->frame().broken_edges.size(), kFrames - 1u);
  EXPECT_EQ(stream.end()->reason(), v1::END_REASON_GOAL_REACHED);
  EXPECT_EQ(stream.mesh_asset(), "mesh");
  EXPECT_EQ(stream.head_frame(), kFrames - 1);
}

TEST(FrameStream, CutInsideAFrameLosesAndRepeatsNothing) {
  for (const bool can_resume : {true, false}) {
    for (const grpc::Status& cut :
         {grpc::Status(grpc::StatusCode::UNAVAILABLE, "cut"), grpc::Status(grpc::Status::OK)}) {
      FakeFrames service;
      service.cut_in_frame = 7;
      service.cut_status = cut;
      service.can_resume = can_resume;
      FakeServer server(service);
      FrameStreamOptions options = Options();
      options.rest_positions = RestPositions();
      int cuts = 0;
      options.on_cut = [&](const absl::Status&, std::chrono::milliseconds) { ++cuts; };
      FrameStream stream(server.client(), options);
      absl::Status status;
      EXPECT_EQ(Drain(stream, status), Numbers(0, kFrames - 1));
      EXPECT_TRUE(status.ok()) << status;
      EXPECT_EQ(cuts, 1);
      EXPECT_EQ(service.streams, 2);
      EXPECT_EQ(stream.position()->state_hash, service.frames.back().header.state_hash);
    }
  }
}

TEST(FrameStream, GoesOnBehindAFrameThatTheCallerHolds) {
  FakeFrames service;
  FakeServer server(service);
  FrameStreamOptions options = Options();
  options.resume = FramePosition{0, 6, service.frames[6].header.state_hash};
  options.stop_frame = 9;
  FrameStream stream(server.client(), options);
  absl::Status status;
  EXPECT_EQ(Drain(stream, status), Numbers(7, 9));
  EXPECT_TRUE(status.ok()) << status;
}

TEST(FrameStream, DamagedFrameIsDataLossAndNoFrame) {
  FakeFrames service;
  service.damaged_frame = 4;
  FakeServer server(service);
  FrameStream stream(server.client(), Options());
  absl::Status status;
  EXPECT_EQ(Drain(stream, status), Numbers(0, 3));
  EXPECT_TRUE(absl::IsDataLoss(status)) << status;
}

TEST(FrameStream, TellsWhatWasLeftOutBeforeAFrame) {
  FakeFrames service;
  FakeServer server(service);
  service.gap_at = 3;
  FrameStreamOptions options = Options();
  options.latest = true;
  options.rest_positions = RestPositions();
  FrameStream stream(server.client(), options);
  std::vector<int64_t> numbers;
  for (auto frame = stream.Next(); frame.ok() && frame->has_value(); frame = stream.Next()) {
    numbers.push_back((*frame)->header.frame);
    ASSERT_EQ((*frame)->gap.has_value(), numbers.back() == 10);
    if (!(*frame)->gap.has_value()) continue;
    EXPECT_EQ((*frame)->gap->first_frame, 3);
    EXPECT_EQ((*frame)->gap->last_frame, 9);
  }
  EXPECT_TRUE(stream.end().has_value());
  EXPECT_THAT(numbers, testing::ElementsAre(0, 1, 2, 10, 11));
}

TEST(FrameStream, GapOfFramesThatWereGivenIsNone) {
  FakeFrames service;
  FakeServer server(service);
  service.can_resume = false;
  FrameStreamOptions options = Options();
  options.latest = true;
  const auto resume_behind = [&](int64_t frame) {
    options.resume =
        FramePosition{0, frame, service.frames[static_cast<size_t>(frame)].header.state_hash};
    FrameStream stream(server.client(), options);
    std::vector<std::optional<FrameGap>> gaps;
    for (auto next = stream.Next(); next.ok() && next->has_value(); next = stream.Next())
      gaps.push_back((*next)->gap);
    return gaps;
  };
  // The server counts from key frame 5; the viewer has 7.
  service.gap_at = 5;
  auto gaps = resume_behind(7);
  ASSERT_EQ(gaps.size(), 2u);
  ASSERT_TRUE(gaps[0].has_value());
  EXPECT_EQ(gaps[0]->first_frame, 8);
  gaps = resume_behind(9);
  ASSERT_EQ(gaps.size(), 2u);
  EXPECT_FALSE(gaps[0].has_value());
  gaps = resume_behind(10);
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_FALSE(gaps[0].has_value());
}

TEST(FrameStream, GapThatNobodyAskedForOrThatIsNoneIsDataLoss) {
  const auto status_of = [](bool latest, const auto& spoil) {
    FakeFrames service;
    FakeServer server(service);
    service.gap_at = 3;
    spoil(service);
    FrameStreamOptions options = Options();
    options.latest = latest;
    FrameStream stream(server.client(), options);
    absl::Status status;
    EXPECT_THAT(Drain(stream, status), testing::ElementsAre(0, 1, 2));
    return status;
  };
  EXPECT_TRUE(absl::IsDataLoss(status_of(false, [](FakeFrames&) {})));
  for (const int64_t from : {int64_t{10}, int64_t{-7}}) {
    EXPECT_TRUE(absl::IsDataLoss(status_of(true, [&](FakeFrames& s) { s.gap_from = from; })));
  }
  EXPECT_TRUE(absl::IsDataLoss(status_of(true, [](FakeFrames& s) { s.gap_twice = true; })));
  EXPECT_TRUE(absl::IsDataLoss(status_of(true, [](FakeFrames& s) { s.gap_to = 9; })));  // no key
}

TEST(FrameStream, ServerThatRestartsIsWaitedFor) {
  FakeFrames service;
  service.refusals = 2;
  FakeServer server(service);
  FrameStream stream(server.client(), Options());
  absl::Status status;
  EXPECT_EQ(Drain(stream, status), Numbers(0, kFrames - 1));
  EXPECT_TRUE(status.ok()) << status;
  EXPECT_EQ(service.streams, 3);
}

TEST(FrameStream, CancelFromAnotherThreadEndsAWaitingStream) {
  FakeFrames service;
  FakeServer server(service);
  FrameStreamOptions options = Options();
  options.follow = true;
  FrameStream stream(server.client(), options);
  absl::Status status;
  std::thread canceller;
  int64_t last = -1;
  while (true) {
    auto frame = stream.Next();
    status = frame.status();
    if (!frame.ok() || !frame->has_value()) break;
    last = (*frame)->header.frame;
    if (last == kFrames - 1) canceller = std::thread([&] { stream.Cancel(); });
  }
  canceller.join();
  service.viewer_left.Notify();
  EXPECT_EQ(last, kFrames - 1);
  EXPECT_TRUE(absl::IsCancelled(status)) << status;
}

}  // namespace
}  // namespace cleave
