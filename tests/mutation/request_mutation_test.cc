#include <dirent.h>
#include <google/protobuf/stubs/logging.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <map>

#include "absl/strings/escaping.h"
#include "cleave/v1/asset.grpc.pb.h"
#include "cleave/v1/frame.grpc.pb.h"
#include "cleave/v1/session.grpc.pb.h"
#include "client/cpp/mesh_transfer.h"
#include "core/base/crc32c.h"
#include "core/base/sha256.h"
#include "core/scene/validate.h"
#include "proto/convert/mesh.h"
#include "proto/convert/scene.h"
#include "tests/integration/test_server.h"
#include "tests/mutation/mutate.h"

namespace cleave {
namespace {

using namespace std::chrono_literals;

// An answer that takes longer is a hang. Generous, because sanitizers are slow.
constexpr auto kPatience = 30s;
// Calls that rightly wait for frames or changes are given up after this.
constexpr auto kGlance = 30ms;

v1::Scene SmallScene() {
  v1::Scene scene = BreakingBar(2);
  scene.mutable_mesh()->mutable_box()->mutable_resolution()->set_cell_size(0.1);
  return scene;
}

std::string SmallMesh() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return *SerializeMesh(mesh);
}

// Closed, of the size of the small scene's bar.
RenderMesh SmallRenderMesh() {
  RenderMesh mesh;
  mesh.points = {{0, 0, 0}, {0.4, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  mesh.uvs.resize(4);
  return mesh;
}

int OpenFiles(pid_t pid) {
  DIR* directory = opendir(("/proc/" + std::to_string(pid) + "/fd").c_str());
  if (directory == nullptr) return -1;
  int count = 0;
  while (readdir(directory) != nullptr) ++count;
  closedir(directory);
  return count;
}

// One server for all tests of this file, with a session to talk about.
class MutatedRequests : public testing::Test {
 protected:
  MutatedRequests()
      : channel_(grpc::CreateChannel(server_.address(), grpc::InsecureChannelCredentials())),
        generic_(channel_),
        sessions_(v1::SessionService::NewStub(channel_)),
        assets_(v1::AssetService::NewStub(channel_)),
        frames_(v1::FrameService::NewStub(channel_)),
        client_(server_.Connect()) {
    const auto uploaded = UploadRenderMesh(*client_, SmallRenderMesh(), nullptr);
    EXPECT_TRUE(uploaded.ok()) << uploaded.status();
    render_mesh_ = uploaded->asset;
    Create(*client_, "bar", SmallScene());
    RunToEnd(*client_, "bar");
    open_files_ = OpenFiles(server_.pid());
  }

  // The server is still there, answers, and holds no file more than before.
  ~MutatedRequests() override {
    const absl::StatusOr<v1::Session> session = client_->GetSession("sessions/bar");
    EXPECT_TRUE(session.ok()) << session.status() << "\n" << server_.log();
    EXPECT_LE(OpenFiles(server_.pid()), open_files_ + 10);
    EXPECT_EQ(server_.log().find("Sanitizer"), std::string::npos) << server_.log();
    EXPECT_EQ(server_.Stop(), 0) << server_.log();
  }

  static void SetDeadline(grpc::ClientContext& context, std::chrono::milliseconds limit) {
    context.set_deadline(std::chrono::system_clock::now() + limit);
  }
  // Counts, and fails the test for a call that hung or a server that went away.
  bool Judge(const grpc::Status& status, bool may_wait = false) {
    ++counts_[status.error_code()];
    if (!may_wait) {
      EXPECT_NE(status.error_code(), grpc::DEADLINE_EXCEEDED);
    }
    EXPECT_NE(status.error_code(), grpc::UNAVAILABLE) << status.error_message();
    EXPECT_NE(status.error_code(), grpc::INTERNAL) << status.error_message();
    return status.ok();
  }

  // Sends any bytes as the body of a unary call.
  grpc::Status SendBytes(const std::string& method, const std::string& body) {
    grpc::ClientContext context;
    SetDeadline(context, kPatience);
    const grpc::Slice slice(body);
    const grpc::ByteBuffer request(&slice, 1);
    grpc::ByteBuffer response;
    std::promise<grpc::Status> done;
    generic_.UnaryCall(&context, method, {}, &request, &response,
                       [&done](grpc::Status status) { done.set_value(std::move(status)); });
    return done.get_future().get();
  }

  v1::CreateSessionRequest CreateRequest() {
    v1::CreateSessionRequest request;
    request.set_session_id("mutant-" + std::to_string(created_++));
    *request.mutable_scene() = SmallScene();
    request.mutable_scene()->mutable_render_mesh()->set_asset(render_mesh_);
    request.set_validate_only(true);
    return request;
  }

  TestServer server_;
  std::shared_ptr<grpc::Channel> channel_;
  grpc::GenericStub generic_;
  std::unique_ptr<v1::SessionService::Stub> sessions_;
  std::unique_ptr<v1::AssetService::Stub> assets_;
  std::unique_ptr<v1::FrameService::Stub> frames_;
  std::unique_ptr<Client> client_;
  std::string render_mesh_;  // an asset of the server
  std::map<int, int> counts_;
  int created_ = 0;
  int open_files_ = 0;
};

TEST_F(MutatedRequests, OfRandomBytesLeaveTheServerAnswering) {
  const google::protobuf::LogSilencer quiet;
  v1::GetSessionRequest get;
  get.set_name("sessions/bar");
  v1::StepSessionRequest step;
  step.set_name("sessions/bar");
  step.set_frames(1);
  v1::FindMissingAssetsRequest find;
  find.add_digests()->set_sha256(std::string(32, 'x'));
  v1::ListFramesRequest list;
  list.set_session("sessions/bar");
  const std::vector<std::pair<std::string, std::string>> calls = {
      {"SessionService/CreateSession", CreateRequest().SerializeAsString()},
      {"SessionService/GetSession", get.SerializeAsString()},
      {"SessionService/ListSessions", std::string("\x08\x05\x12\x03"
                                                  "abc")},
      {"SessionService/StepSession", step.SerializeAsString()},
      {"SessionService/RunSession", get.SerializeAsString()},
      {"SessionService/PauseSession", get.SerializeAsString()},
      {"AssetService/FindMissingAssets", find.SerializeAsString()},
      {"AssetService/QueryUploadStatus", std::string("\x0A\x08"
                                                     "upload-1")},
      {"FrameService/ListFrames", list.SerializeAsString()},
      {"ServerService/GetServerInfo", std::string("\x0A\x01"
                                                  "1")},
  };
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    const auto& [method, body] = calls[seed % calls.size()];
    Judge(SendBytes("/cleave.v1." + method, MutateBytes(body, dice)));
  }
  EXPECT_GT(counts_[grpc::OK], 0);
  EXPECT_GT(counts_[grpc::INVALID_ARGUMENT], 0);
}

TEST_F(MutatedRequests, ToCreateAreRefusedWithFieldsOrSound) {
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    v1::CreateSessionRequest request = CreateRequest();
    if (dice.OneIn(2)) {
      MutateMessage(request, dice);
    } else {
      MutateMessage(*request.mutable_scene(), dice);
    }
    // Bodies of a million tets are allowed and slow; damage is what is looked for here.
    if (request.scene().mesh().has_box()) {
      request.mutable_scene()->mutable_mesh()->mutable_box()->mutable_resolution()->set_cell_size(
          std::max(0.05, request.scene().mesh().box().resolution().cell_size()));
    }
    grpc::ClientContext context;
    SetDeadline(context, kPatience);
    v1::CreateSessionResponse response;
    const grpc::Status status = sessions_->CreateSession(&context, request, &response);
    if (!Judge(status)) {
      EXPECT_FALSE(status.error_message().empty());
      continue;
    }
    Faults faults;
    const Scene scene = SceneFromMessage(request.scene(), faults);
    faults.Append("", ValidateScene(scene));
    EXPECT_TRUE(faults.ok()) << "a wrong OK: " << faults.ToStatus();
    EXPECT_GT(response.plan().tet_count(), 0);
    if (!request.validate_only()) {
      EXPECT_TRUE(client_->DeleteSession(response.session().name(), false).ok());
    }
  }
  EXPECT_GT(counts_[grpc::OK], 30);
  EXPECT_GT(counts_[grpc::INVALID_ARGUMENT], 300);
}

TEST_F(MutatedRequests, ToUploadAreNeverCompleteWithOtherBytes) {
  for (uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    const bool renders = dice.OneIn(2);
    const std::string mesh = renders ? *SerializeRenderMesh(SmallRenderMesh()) : SmallMesh();
    v1::UploadAssetRequest first, last;
    first.set_upload_id("upload-" + std::to_string(seed));
    first.mutable_spec()->set_kind(renders ? v1::ASSET_KIND_RENDER_MESH : v1::ASSET_KIND_TET_MESH);
    first.mutable_spec()->mutable_digest()->set_sha256(Sha256::Of(mesh));
    first.mutable_spec()->mutable_digest()->set_size_bytes(static_cast<int64_t>(mesh.size()));
    first.set_payload(mesh.substr(0, 50));
    last.set_upload_id(first.upload_id());
    last.set_offset(50);
    last.set_payload(mesh.substr(50));
    last.set_finish(true);
    for (v1::UploadAssetRequest* chunk : {&first, &last}) {
      chunk->set_raw_size(static_cast<uint32_t>(chunk->payload().size()));
      chunk->set_crc32c(Crc32c(chunk->payload()));
    }
    MutateMessage(dice.OneIn(2) ? first : last, dice);

    grpc::ClientContext context;
    SetDeadline(context, kPatience);
    v1::UploadAssetResponse response;
    const auto stream = assets_->UploadAsset(&context, &response);
    if (stream->Write(first)) stream->Write(last);
    stream->WritesDone();
    if (!Judge(stream->Finish()) || !response.status().complete()) continue;
    EXPECT_EQ(response.asset(), absl::BytesToHexString(Sha256::Of(mesh)));
  }
  EXPECT_GT(counts_[grpc::INVALID_ARGUMENT] + counts_[grpc::DATA_LOSS], 100);
}

TEST_F(MutatedRequests, ToStreamEndOrAreCut) {
  for (uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    v1::StreamFramesRequest request;
    request.set_session("sessions/bar");
    request.mutable_resume()->set_frame(1);
    request.set_stop_frame(2);
    MutateMessage(request, dice);
    grpc::ClientContext context;
    SetDeadline(context, kGlance);
    const auto stream = frames_->StreamFrames(&context, request);
    v1::StreamFramesResponse response;
    bool first = true;
    while (stream->Read(&response)) {
      EXPECT_EQ(response.has_start(), first);
      first = false;
    }
    Judge(stream->Finish(), /*may_wait=*/true);
  }
  EXPECT_GT(counts_[grpc::OK], 30);
}

}  // namespace
}  // namespace cleave
