// Viewers ask for different accuracies of one session, come and go, and programs die under them.

#include <gmock/gmock.h>
#include <grpcpp/client_context.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/client.h"
#include "client/cpp/frame_stream.h"
#include "client/cpp/mesh_transfer.h"
#include "client/cpp/stubs.h"
#include "core/mesh/incidence.h"
#include "tests/integration/frame_streams.h"
#include "tests/integration/test_server.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

constexpr int kKeyframeInterval = 7;  // of BreakingBar

// What a preview of the whole run is when nothing disturbs it, asked for when the run is over.
const std::vector<std::string>& UndisturbedPreview() {
  static const std::vector<std::string> frames = [] {
    TestServer server;
    const std::unique_ptr<Client> client = server.Connect();
    Create(*client, "bar", BreakingBar(kFrames));
    RunToEnd(*client, "bar");
    return TakeAll(*client, Rung::kPreview);
  }();
  return frames;
}

double Largest(const std::vector<Vec3>& one, const std::vector<Vec3>& other) {
  double largest = 0;
  for (size_t node = 0; node < one.size(); ++node)
    for (size_t axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(one[node][axis] - other[node][axis]));
  return largest;
}

TEST(RungsTest, FourViewersSeeOneRunEachAtItsOwnAccuracy) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  EXPECT_EQ(CreateLossless(*client).rung(), v1::RUNG_LOSSLESS);
  WaitFor(*client, "bar", Rests);
  const absl::StatusOr<v1::Session> with_scene = client->GetSession("sessions/bar");
  const absl::StatusOr<TetMesh> mesh =
      DownloadMesh(*client, with_scene->scene().mesh().asset(), {});
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_TRUE(client->RunSession("sessions/bar", {}).ok());

  std::vector<std::unique_ptr<FrameStream>> streams;
  for (const Rung rung : kRungs) {
    FrameStreamOptions options = Asking(rung);
    options.rest_positions = mesh->rest_positions;
    options.edges = BuildIncidence(*mesh).edges;
    streams.push_back(std::make_unique<FrameStream>(*client, std::move(options)));
    ASSERT_TRUE(streams.back()->Open().ok());
    EXPECT_EQ(streams.back()->rung(), rung);
  }
  const double fine = streams[2]->tolerance();
  EXPECT_NEAR(streams[0]->tolerance(), 100 * fine, 1e-12);
  EXPECT_NEAR(streams[1]->tolerance(), 10 * fine, 1e-12);
  EXPECT_EQ(streams[3]->tolerance(), 0);
  std::vector<size_t> bytes(4);
  for (int64_t frame = 0; frame <= kFrames; ++frame) {
    for (size_t at = 0; at < streams.size(); ++at) {
      const absl::StatusOr<std::optional<StreamedFrame>> next = streams[at]->Next();
      ASSERT_TRUE(next.ok()) << next.status() << server.log();
      ASSERT_EQ((*next)->header.frame, frame);
      bytes[at] += (*next)->bytes.size();
    }
    const Frame& truth = streams[3]->decoder()->frame();
    for (size_t at = 0; at < 3; ++at) {
      const Frame& shown = streams[at]->decoder()->frame();
      ASSERT_EQ(shown.broken_edges, truth.broken_edges);
      ASSERT_EQ(shown.fragments, truth.fragments);
      ASSERT_LE(Largest(shown.positions, truth.positions), streams[at]->tolerance());
    }
  }
  for (const auto& stream : streams) {
    EXPECT_FALSE((*stream->Next()).has_value());
    EXPECT_EQ(stream->end()->reason(), v1::END_REASON_GOAL_REACHED);
  }
  EXPECT_LT(bytes[0], bytes[1]);
  EXPECT_LT(bytes[1], bytes[2]);
  EXPECT_LT(bytes[2], bytes[3]);
}

TEST(RungsTest, AToleranceIsSnappedDownAndOneFinerThanKeptIsRefused) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(kFrames));
  WaitFor(*client, "bar", Rests);
  FrameStream standard(*client, Asking(Rung::kStandard));
  ASSERT_TRUE(standard.Open().ok());
  EXPECT_EQ(standard.rung(), Rung::kStandard);

  FrameStream fine(*client, Asking(Rung::kFine));
  const absl::Status refused = fine.Open();
  EXPECT_TRUE(absl::IsFailedPrecondition(refused)) << refused;
  EXPECT_THAT(std::string(refused.message()), HasSubstr("rung: a tolerance of"));

  // Asked for in metres: never coarser than asked.
  for (const auto& [asked, given] : std::vector<std::pair<double, Rung>>{{1.0, Rung::kStandard},
                                                                         {1.2, Rung::kStandard},
                                                                         {9.9, Rung::kStandard},
                                                                         {10.1, Rung::kPreview},
                                                                         {1e6, Rung::kPreview}}) {
    FrameStreamOptions options = Asking(std::nullopt);
    options.tolerance = asked * standard.tolerance();
    FrameStream stream(*client, options);
    ASSERT_TRUE(stream.Open().ok()) << asked;
    EXPECT_EQ(stream.rung(), given) << asked;
    EXPECT_LE(stream.tolerance(), *options.tolerance);
  }
  for (const double asked : {-1.0, std::nan("")}) {
    FrameStreamOptions options = Asking(std::nullopt);
    options.tolerance = asked;
    FrameStream stream(*client, options);
    EXPECT_TRUE(absl::IsInvalidArgument(stream.Open())) << asked;
  }
}

TEST(RungsTest, ARungThatNobodyWatchesCostsNothing) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(kFrames));
  RunToEnd(*client, "bar");
  EXPECT_FALSE(std::filesystem::exists(server.session_directory("bar") + "/rungs"));
  EXPECT_THAT(server.log(), testing::Not(HasSubstr("rung_worker_started")));
  EXPECT_EQ(TakeAll(*client, Rung::kPreview).size(), static_cast<size_t>(kFrames + 1));
  // Its worker leaves with the last viewer, and the next finds everything encoded.
  const std::string index = server.session_directory("bar") + "/rungs/preview/index";
  const auto written = std::filesystem::last_write_time(index);
  EXPECT_EQ(TakeAll(*client, Rung::kPreview), UndisturbedPreview());
  EXPECT_EQ(std::filesystem::last_write_time(index), written);
  EXPECT_EQ(server.Stop(), 0) << server.log();
  EXPECT_THAT(server.log(), HasSubstr("rung=preview how=\"exit code 0\""));
}

TEST(RungsTest, ARungHasTheSameBytesWhoeverComesWhenAndWhateverDies) {
  ASSERT_EQ(UndisturbedPreview().size(), static_cast<size_t>(kFrames + 1));
  // Up to the last key frame: the frames behind it depend on where the run ends.
  const auto begin = UndisturbedPreview().begin();
  const auto end = begin + kFrames / kKeyframeInterval * kKeyframeInterval + 1;
  const int64_t count = end - begin;
  // The same run, too long to end before whatever dies below.
  constexpr int64_t kEndless = 100'000;
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(kEndless));
  ASSERT_TRUE(client->RunSession("sessions/bar", {}).ok());
  FrameStream kept(*client, Asking(std::nullopt));
  FrameStream preview(*client, Asking(Rung::kPreview));
  EXPECT_EQ(Take(kept, 10).size(), 10u);
  std::vector<std::string> frames = Take(preview, 12);
  std::optional<FramePosition> position;
  {
    // A viewer who leaves in the middle of a second of frames, for good as far as it knows.
    FrameStream other(*client, Asking(Rung::kPreview));
    EXPECT_EQ(Take(other, 10), std::vector(begin, begin + 10));
    position = other.position();
  }
  const std::string owner = server.session_directory("bar") + "/rungs/preview.owner";
  ASSERT_EQ(kill(std::stoi(ReadBytes(owner)), SIGKILL), 0);
  for (std::string& frame : Take(preview, 8)) frames.push_back(std::move(frame));
  server.Kill();
  const std::string reports = ReadBytes(server.session_directory("bar") + "/reports.jsonl");
  EXPECT_LT(std::count(reports.begin(), reports.end(), '\n'), kEndless);
  server.Start();
  for (std::string& frame : Take(preview, count - 20)) frames.push_back(std::move(frame));
  EXPECT_EQ(frames, std::vector(begin, end));
  EXPECT_EQ(static_cast<int64_t>(Take(kept, count - 10).size()), count - 10);

  // The viewer who left comes back with what it has: the very next frame follows, a delta.
  FrameStreamOptions resumed = Asking(Rung::kPreview);
  resumed.resume = position;
  FrameStream back(*client, resumed);
  EXPECT_EQ(Take(back, count - 10), std::vector(begin + 10, end));

  // Late, in the middle: from the key frame before.
  FrameStreamOptions late = Asking(Rung::kPreview);
  late.first_frame = 40;
  FrameStream latecomer(*client, late);
  const int64_t first = 40 / kKeyframeInterval * kKeyframeInterval;
  EXPECT_EQ(Take(latecomer, count - first), std::vector(begin + first, end));
  EXPECT_EQ(client->GetSession("sessions/bar")->state(), v1::SESSION_STATE_RUNNING);
}

TEST(RungsTest, ADamagedLogOfARungIsMadeAgain) {
  TestServer server;
  {
    const std::unique_ptr<Client> client = server.Connect();
    Create(*client, "bar", BreakingBar(kFrames));
    RunToEnd(*client, "bar");
    EXPECT_EQ(TakeAll(*client, Rung::kPreview), UndisturbedPreview());
  }
  ASSERT_EQ(server.Stop(), 0);
  const std::string directory = server.session_directory("bar") + "/rungs/preview";
  std::string bytes = ReadBytes(directory + "/00000000.clv");
  bytes[bytes.size() - 20] ^= 1;
  WriteBytes(directory + "/00000000.clv", bytes);
  std::string rows = ReadBytes(directory + "/index");
  rows.resize(rows.size() / 2);
  WriteBytes(directory + "/index", rows);
  server.Start();
  EXPECT_EQ(TakeAll(*server.Connect(), Rung::kPreview), UndisturbedPreview());
}

TEST(RungsTest, ARungThatCannotBeBegunSaysThatItHasNoFrame) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(kKeyframeInterval));
  RunToEnd(*client, "bar");
  WriteBytes(server.session_directory("bar") + "/rungs", "no folder");
  FrameStream stream(*client, Asking(Rung::kPreview));
  const absl::Status refused = stream.Open();
  EXPECT_EQ(refused.code(), absl::StatusCode::kInternal);
  EXPECT_THAT(std::string(refused.message()),
              HasSubstr("the rung preview of sessions/bar has no frame: "));
}

TEST(RungsTest, WhoWantsTheLatestSkipsToTheNewestKeyFrame) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(kFrames));
  const std::vector<std::string> all = RunToEnd(*client, "bar");
  v1::StreamFramesRequest request;
  request.set_session("sessions/bar");
  request.set_latest(true);
  grpc::ClientContext context;
  const auto reader = client->stubs().frames->StreamFrames(&context, request);
  v1::StreamFramesResponse response;
  ASSERT_TRUE(reader->Read(&response) && response.has_start());
  ASSERT_TRUE(reader->Read(&response));
  constexpr int64_t kNewest = kFrames / kKeyframeInterval * kKeyframeInterval;
  EXPECT_EQ(response.gap().first_frame(), 0);
  EXPECT_EQ(response.gap().last_frame(), kNewest - 1);
  context.TryCancel();

  // Of a rung whose frames are there as well: before, a viewer of it is not behind.
  FrameStreamOptions options = Asking(Rung::kPreview);
  FrameStream whole(*client, options);
  EXPECT_EQ(TakeAll(whole).size(), all.size());
  options.latest = true;
  FrameStream stream(*client, options);
  auto first = stream.Next();
  ASSERT_TRUE(first.ok() && first->has_value());
  ASSERT_TRUE((*first)->gap.has_value());
  EXPECT_EQ((*first)->gap->first_frame, 0);
  EXPECT_EQ((*first)->gap->last_frame, kNewest - 1);
  EXPECT_EQ((*first)->header.frame, kNewest);
  EXPECT_EQ(TakeAll(stream).back(), UndisturbedPreview().back());
}

// The names that a viewer knows after a frame, by piece.
using Names = std::map<int32_t, int32_t>;

void Learn(const v1::FrameEvents& events, Names& names) {
  if (events.pieces_size() > 0) names.clear();
  for (const v1::Piece& piece : events.pieces()) names[piece.piece()] = piece.first_node();
  for (const v1::PieceSplit& split : events.splits()) {
    ASSERT_TRUE(names.contains(split.kept().piece()));
    names[split.kept().piece()] = split.kept().first_node();
    for (const v1::Separation& off : split.separations()) {
      ASSERT_TRUE(names.try_emplace(off.part().piece(), off.part().first_node()).second);
    }
  }
}

TEST(RungsTest, WhoeverJoinsHasTheNamesOfThePiecesAtOnce) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(150));
  RunToEnd(*client, "bar");
  std::vector<Names> known;  // a frame each
  FrameStreamOptions options = Asking(std::nullopt);
  options.events = true;
  {
    FrameStream stream(*client, options);
    Names names;
    for (auto frame = *stream.Next(); frame.has_value(); frame = *stream.Next()) {
      EXPECT_EQ(frame->events.pieces_size() > 0, frame->header.frame == 0);
      Learn(frame->events, names);
      EXPECT_EQ(static_cast<int64_t>(names.size()), frame->header.fragments);
      known.push_back(names);
    }
  }
  ASSERT_EQ(known.size(), 151u);
  ASSERT_GT(known.back().size(), 1u);
  for (const int64_t first : {1, 40, 100, 150}) {
    options.first_frame = first;
    options.rung = first == 40 ? std::optional(Rung::kPreview) : std::nullopt;
    FrameStream stream(*client, options);
    Names names;
    for (auto frame = *stream.Next(); frame.has_value(); frame = *stream.Next()) {
      Learn(frame->events, names);
      ASSERT_EQ(names, known[static_cast<size_t>(frame->header.frame)]) << frame->header.frame;
    }
  }
  options.latest = true;
  options.first_frame = 0;
  FrameStream latest(*client, options);
  Names names;
  for (auto frame = *latest.Next(); frame.has_value(); frame = *latest.Next()) {
    Learn(frame->events, names);
    ASSERT_EQ(names, known[static_cast<size_t>(frame->header.frame)]) << frame->header.frame;
  }
  EXPECT_EQ(names, known.back());
}

TEST(RungsTest, ASessionCanBeDeletedWhileARungIsEncoded) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(100'000));
  ASSERT_TRUE(client->RunSession("sessions/bar", {}).ok());
  FrameStream stream(*client, Asking(Rung::kPreview));
  EXPECT_EQ(Take(stream, 3).size(), 3u);
  ASSERT_TRUE(client->DeleteSession("sessions/bar", false).ok());
  absl::StatusOr<std::optional<StreamedFrame>> frame = stream.Next();
  while (frame.ok() && frame->has_value()) frame = stream.Next();
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(stream.end()->reason(), v1::END_REASON_DELETED);
  EXPECT_FALSE(std::filesystem::exists(server.session_directory("bar")));
}

TEST(RungsTest, ARungAndAToleranceTogetherAreRefusedWhenASessionIsCreated) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  v1::CreateSessionRequest request;
  request.set_session_id("bar");
  *request.mutable_scene() = BreakingBar(kFrames);
  request.mutable_scene()->mutable_output()->set_tolerance(1e-4);
  request.set_rung(v1::RUNG_FINE);
  absl::Status status = client->CreateSession(request).status();
  EXPECT_THAT(std::string(status.message()), HasSubstr("rung: scene.output.tolerance"));
  request.set_rung(static_cast<v1::Rung>(17));
  status = client->CreateSession(request).status();
  EXPECT_THAT(std::string(status.message()), HasSubstr("rung: 17 is no rung"));
}

}  // namespace
}  // namespace cleave
