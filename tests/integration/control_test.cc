// Running, stepping and pausing sessions, and what bad or unlucky calls are told.

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <future>

#include "absl/strings/str_cat.h"
#include "client/cpp/client.h"
#include "client/cpp/frame_stream.h"
#include "client/cpp/rpc_error.h"
#include "client/cpp/stubs.h"
#include "proto/convert/probe.h"
#include "tests/integration/test_server.h"

namespace cleave {
namespace {

using namespace std::chrono_literals;
using ::testing::IsSupersetOf;

class ControlTest : public testing::Test {
 protected:
  void SetUp() override {
    client_ = server_.Connect();
    ASSERT_NE(client_, nullptr);
  }

  absl::Status CreateError(const v1::CreateSessionRequest& request) {
    return client_->CreateSession(request).status();
  }

  TestServer server_;
  std::unique_ptr<Client> client_;
};

std::vector<std::string> FieldsOf(const absl::Status& status) {
  std::vector<std::string> fields;
  for (const Fault& fault : FaultsOf(status)) fields.push_back(fault.field);
  return fields;
}

TEST_F(ControlTest, StepsAddUpToARun) {
  Create(*client_, "run", BreakingBar(6));
  const std::vector<std::string> expected = RunToEnd(*client_, "run");
  Create(*client_, "steps", BreakingBar(6));
  int64_t head = 0;
  for (const uint32_t frames : {1u, 2u, 3u}) {
    const absl::StatusOr<v1::StepSessionResponse> step =
        client_->StepSession("sessions/steps", frames, head, 100s);
    ASSERT_TRUE(step.ok()) << step.status();
    EXPECT_EQ(step->frames_done(), frames);
    EXPECT_FALSE(step->deadline_reached());
    head = step->session().head_frame();
  }
  EXPECT_EQ(head, 6);
  EXPECT_EQ(AllFrames(*client_, "steps"), expected);
}

TEST_F(ControlTest, AStepFromAnotherHeadIsRefusedAndChangesNothing) {
  Create(*client_, "bar", BreakingBar(6));
  ASSERT_TRUE(client_->StepSession("sessions/bar", 1, 0, 100s).ok());
  const absl::Status refused = client_->StepSession("sessions/bar", 1, 0, 100s).status();
  EXPECT_EQ(ReasonOf(refused), "HEAD_MOVED") << refused;
  EXPECT_EQ(client_->GetSession("sessions/bar")->head_frame(), 1);
}

TEST_F(ControlTest, AStepAnswersInTimeForItsDeadlineAlsoInsideAFrameThatTakesHours) {
  Create(*client_, "endless", EndlessFrame());
  WaitFor(*client_, "endless", Rests);
  const absl::StatusOr<v1::StepSessionResponse> step =
      client_->StepSession("sessions/endless", 1, 0, 2s);
  ASSERT_TRUE(step.ok()) << step.status();
  EXPECT_EQ(step->frames_done(), 0u);
  EXPECT_TRUE(step->deadline_reached());
  EXPECT_EQ(WaitFor(*client_, "endless", Rests).head_frame(), 0);
}

TEST_F(ControlTest, AnAbortingPauseReturnsFromInsideAFrameToTheLastCommittedOne) {
  Create(*client_, "endless", EndlessFrame());
  WaitFor(*client_, "endless", Rests);
  ASSERT_TRUE(client_->RunSession("sessions/endless", {}).ok());
  WaitFor(*client_, "endless",
          [](const v1::Session& session) { return session.state() == v1::SESSION_STATE_RUNNING; });
  const absl::StatusOr<v1::Session> paused = client_->PauseSession("sessions/endless", true);
  ASSERT_TRUE(paused.ok()) << paused.status();
  EXPECT_EQ(paused->state(), v1::SESSION_STATE_IDLE);
  EXPECT_EQ(paused->head_frame(), 0);
}

TEST_F(ControlTest, ARunThatIsAbortedAgainAndAgainGivesTheSameFrames) {
  Create(*client_, "calm", BreakingBar(12));
  const std::vector<std::string> expected = RunToEnd(*client_, "calm");
  Create(*client_, "nervous", BreakingBar(12));
  WaitFor(*client_, "nervous", Rests);
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(client_->RunSession("sessions/nervous", {}).ok());
    ASSERT_TRUE(client_->PauseSession("sessions/nervous", true).ok());
  }
  EXPECT_EQ(RunToEnd(*client_, "nervous"), expected);
}

TEST_F(ControlTest, HealthAnswersWhileEveryCoreSolvesAndCallsWait) {
  std::vector<std::future<absl::StatusOr<v1::StepSessionResponse>>> steps;
  for (const char* id : {"one", "two", "three", "four"}) {
    Create(*client_, id, EndlessFrame());
    WaitFor(*client_, id, Rests);
    steps.push_back(std::async(std::launch::async, [this, id] {
      return client_->StepSession(SessionName(id), 1, 0, 3s);
    }));
  }
  grpc::GenericStub stub(
      grpc::CreateChannel(server_.address(), grpc::InsecureChannelCredentials()));
  const auto waiting = [&] {
    return std::any_of(steps.begin(), steps.end(), [](const auto& step) {
      return step.wait_for(0s) != std::future_status::ready;
    });
  };
  while (waiting()) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + 2s);
    context.set_wait_for_ready(true);
    const grpc::Slice everything("");  // an empty HealthCheckRequest: the whole server
    grpc::ByteBuffer request(&everything, 1);
    grpc::ByteBuffer response;
    std::promise<grpc::Status> answered;
    stub.UnaryCall(&context, "/grpc.health.v1.Health/Check", {}, &request, &response,
                   [&](const grpc::Status& status) { answered.set_value(status); });
    const grpc::Status status = answered.get_future().get();
    ASSERT_TRUE(status.ok()) << status.error_message();
    grpc::Slice bytes;
    ASSERT_TRUE(response.DumpToSingleSlice(&bytes).ok());
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "\x08\x01");  // status: SERVING
  }
  for (auto& step : steps) {
    const absl::StatusOr<v1::StepSessionResponse> answer = step.get();
    ASSERT_TRUE(answer.ok()) << answer.status();
    EXPECT_TRUE(answer->deadline_reached());
  }
}

TEST_F(ControlTest, ASessionThatCannotGoOnKeepsItsFramesAndSaysWhy) {
  v1::Scene scene = BreakingBar(20);
  scene.mutable_quality()->set_newton_iterations(1);
  scene.mutable_quality()->set_max_step_halvings(0);
  scene.mutable_quality()->set_residual_tolerance(1e-15);
  scene.mutable_quality()->set_step_tolerance(1e-15);
  Create(*client_, "stuck", scene);
  ASSERT_TRUE(client_->RunSession("sessions/stuck", {}).ok());
  FrameStreamOptions options;
  options.session = "sessions/stuck";
  FrameStream stream(*client_, options);
  int64_t frames = 0;
  while (true) {
    const absl::StatusOr<std::optional<StreamedFrame>> frame = stream.Next();
    ASSERT_TRUE(frame.ok()) << frame.status();
    if (!frame->has_value()) break;
    ++frames;
  }
  EXPECT_EQ(stream.end()->reason(), v1::END_REASON_FAILED);
  EXPECT_GE(frames, 1);
  server_.Kill();
  server_.Start();
  const absl::StatusOr<v1::Session> session = client_->GetSession("sessions/stuck");
  ASSERT_TRUE(session.ok()) << session.status();
  EXPECT_EQ(session->state(), v1::SESSION_STATE_FAILED);
  EXPECT_EQ(session->error().reason(), "SOLVER_DIVERGED");
  EXPECT_EQ(session->head_frame(), frames - 1);
}

TEST_F(ControlTest, CreatingTwiceIsOneSession) {
  v1::CreateSessionRequest request;
  request.set_session_id("bar");
  *request.mutable_scene() = BreakingBar(3);
  request.set_request_id("first");
  const absl::StatusOr<v1::CreateSessionResponse> first = client_->CreateSession(request);
  ASSERT_TRUE(first.ok()) << first.status();
  // The same request, the same scene under the same id, and the request after a restart.
  EXPECT_EQ(client_->CreateSession(request)->session().uid(), first->session().uid());
  request.set_request_id("second");
  EXPECT_EQ(client_->CreateSession(request)->session().uid(), first->session().uid());
  server_.Kill();
  server_.Start();
  request.set_request_id("first");
  EXPECT_EQ(client_->CreateSession(request)->session().uid(), first->session().uid());
  request.set_request_id("third");
  request.mutable_scene()->set_seed(7);
  const absl::Status clash = CreateError(request);
  EXPECT_TRUE(absl::IsAlreadyExists(clash)) << clash;
  EXPECT_EQ(client_->ListSessions()->size(), 1u);
}

TEST_F(ControlTest, EveryFaultOfARequestIsNamedByItsFieldAtOnce) {
  v1::CreateSessionRequest request;
  request.set_session_id("No Good");
  request.set_threads(-1);
  *request.mutable_scene() = BreakingBar(3);
  request.mutable_scene()->mutable_materials(0)->set_poisson_ratio(0.6);
  request.mutable_scene()->mutable_materials(0)->set_density(-1);
  request.mutable_scene()->mutable_motions(0)->set_node_set("nowhere");
  request.mutable_scene()->mutable_timing()->set_frame_count(0);
  const absl::Status status = CreateError(request);
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_EQ(ReasonOf(status), "PARAM_OUT_OF_RANGE");
  EXPECT_THAT(FieldsOf(status),
              IsSupersetOf({"session_id", "threads", "materials[0].poisson_ratio",
                            "materials[0].density", "motions[0].node_set", "timing.frame_count"}));
  EXPECT_TRUE(client_->ListSessions()->empty());
}

TEST_F(ControlTest, AProbedMaterialAnswersTheNumbersOfTheLibrary) {
  v1::ProbeMaterialRequest request;
  request.mutable_material()->set_preset("dry_wood");
  for (const double x : {1, 1, 0, 0, 0, 1}) request.add_pull_directions(x);
  for (const double x : {1.0, 0.01, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0})
    request.add_deformation_gradients(x);
  const absl::StatusOr<v1::ProbeMaterialResponse> response = client_->ProbeMaterial(request);
  ASSERT_TRUE(response.ok()) << response.status();
  Faults faults;
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(
      *response, *AnswerProbe(request, {}, faults)));
  EXPECT_EQ(client_->ListMaterialPresets()->presets_size(), PresetsMessage().presets_size());
}

TEST_F(ControlTest, EveryFaultOfAProbeIsNamedAtOnce) {
  v1::ProbeMaterialRequest request;
  request.mutable_material()->set_preset("oak");
  request.mutable_material()->set_poisson_ratio(0.6);
  request.add_pull_directions(1);
  for (int k = 0; k < 9 * 1001; ++k) request.add_deformation_gradients(0);
  request.set_samples(100'000);
  const absl::Status status = client_->ProbeMaterial(request).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_EQ(ReasonOf(status), "PARAM_OUT_OF_RANGE");
  EXPECT_THAT(FieldsOf(status),
              IsSupersetOf({"material.preset", "material.poisson_ratio", "pull_directions",
                            "deformation_gradients", "samples"}));
}

TEST_F(ControlTest, AHundredFaultsFitIntoAnAnswer) {
  v1::CreateSessionRequest request;
  request.set_session_id("bad");
  *request.mutable_scene() = BreakingBar(3);
  for (int i = 0; i < 300; ++i) {
    v1::Material& material = *request.mutable_scene()->add_materials();
    material = request.scene().materials(0);
    material.set_name("m" + std::to_string(i));
    material.set_poisson_ratio(2);
    material.set_density(-1);
  }
  const absl::Status status = CreateError(request);
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_GT(FaultsOf(status).size(), 20u);
}

TEST_F(ControlTest, AnAssetThatIsNotThereIsNamed) {
  v1::CreateSessionRequest request;
  request.set_session_id("bar");
  *request.mutable_scene() = BreakingBar(3);
  request.mutable_scene()->mutable_mesh()->set_asset(std::string(64, 'a'));
  const absl::Status status = CreateError(request);
  EXPECT_TRUE(absl::IsFailedPrecondition(status)) << status;
  EXPECT_EQ(ReasonOf(status), "ASSET_MISSING");
}

TEST_F(ControlTest, SessionsThatAreNotThereAndNamesThatAreNoneAreToldApart) {
  EXPECT_EQ(ReasonOf(client_->GetSession("sessions/nobody").status()), "SESSION_NOT_FOUND");
  EXPECT_TRUE(absl::IsInvalidArgument(client_->GetSession("nobody").status()));
  EXPECT_TRUE(absl::IsInvalidArgument(client_->GetSession("sessions/../etc").status()));
  EXPECT_TRUE(client_->DeleteSession("sessions/nobody", true).ok());
  EXPECT_TRUE(absl::IsNotFound(client_->DeleteSession("sessions/nobody", false)));
}

TEST_F(ControlTest, ADeletedSessionEndsItsStreamsAndFreesItsName) {
  Create(*client_, "endless", EndlessFrame());
  WaitFor(*client_, "endless", Rests);
  ASSERT_TRUE(client_->RunSession("sessions/endless", {}).ok());
  FrameStreamOptions options;
  options.session = "sessions/endless";
  options.follow = true;
  FrameStream stream(*client_, options);
  ASSERT_TRUE((*stream.Next()).has_value());
  ASSERT_TRUE(client_->DeleteSession("sessions/endless", false).ok());
  EXPECT_FALSE((*stream.Next()).has_value());
  EXPECT_EQ(stream.end()->reason(), v1::END_REASON_DELETED);
  EXPECT_FALSE(std::filesystem::exists(server_.session_directory("endless")));
  Create(*client_, "endless", BreakingBar(2));
  EXPECT_EQ(RunToEnd(*client_, "endless").size(), 3u);
}

TEST_F(ControlTest, ViewersMayComeLateStartAnywhereAndResume) {
  Create(*client_, "bar", BreakingBar(20));
  const std::vector<std::string> frames = RunToEnd(*client_, "bar");
  for (const int64_t first : {0, 6, 7, 13, 20, 1000}) {
    FrameStreamOptions options;
    options.session = "sessions/bar";
    options.first_frame = first;
    FrameStream stream(*client_, options);
    absl::StatusOr<std::optional<StreamedFrame>> frame = stream.Next();
    ASSERT_TRUE(frame.ok() && frame->has_value());
    EXPECT_EQ((*frame)->header.frame, std::min<int64_t>(first, 20) / 7 * 7);
    EXPECT_EQ((*frame)->header.kind, FrameKind::kKey);
  }
  for (size_t held = 0; held < frames.size(); ++held) {
    const FrameHeader header = *ParseFrameHeader(frames[held]);
    FrameStreamOptions options;
    options.session = "sessions/bar";
    options.resume = FramePosition{header.epoch, header.frame, header.state_hash};
    FrameStream stream(*client_, options);
    for (size_t next = held + 1; next < frames.size(); ++next) {
      EXPECT_EQ((*stream.Next())->bytes, frames[next]);
    }
    EXPECT_FALSE((*stream.Next()).has_value());
  }
  v1::ListFramesResponse list = *client_->ListFrames("sessions/bar", 5);
  EXPECT_EQ(list.frames_size(), 16);
  EXPECT_EQ(list.frames(0).frame(), 5);
  EXPECT_EQ(list.next_frame(), -1);
}

TEST_F(ControlTest, ASecondServerOnTheSameSocketOrDataIsRefused) {
  const std::string command =
      absl::StrCat(CLEAVE_BINARY_DIR "/server/gateway/cleaved --listen=", server_.address(),
                   " --data=", server_.data(), "-other 2>/dev/null");
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  const std::string same_data =
      absl::StrCat(CLEAVE_BINARY_DIR "/server/gateway/cleaved --listen=", server_.address(),
                   "2 --data=", server_.data(), " 2>/dev/null");
  EXPECT_EQ(WEXITSTATUS(std::system(same_data.c_str())), 1);
  EXPECT_TRUE(client_->ListSessions().ok());
}

TEST_F(ControlTest, AStoppedServerEndsStreamsWithAMessage) {
  Create(*client_, "bar", BreakingBar(3));
  grpc::ClientContext context;
  v1::StreamFramesRequest request;
  request.set_session("sessions/bar");
  request.set_follow(true);
  const auto reader = client_->stubs().frames->StreamFrames(&context, request);
  v1::StreamFramesResponse message;
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_TRUE(message.has_start());
  // A viewer reads meanwhile; one that does not loses what its socket still holds.
  std::future<int> stopped = std::async(std::launch::async, [this] { return server_.Stop(); });
  while (reader->Read(&message)) {
  }
  EXPECT_EQ(stopped.get(), 0);
  EXPECT_EQ(message.end().reason(), v1::END_REASON_SHUTDOWN);
  const grpc::Status status = reader->Finish();
  EXPECT_TRUE(status.ok()) << status.error_code() << status.error_message() << server_.log();
}

}  // namespace
}  // namespace cleave
