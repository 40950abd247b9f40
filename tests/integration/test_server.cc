#include "tests/integration/test_server.h"

#include <fcntl.h>
#include <grpcpp/client_context.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

#include "client/cpp/frame_stream.h"
#include "client/cpp/stubs.h"

namespace cleave {
namespace {

using namespace std::chrono_literals;

constexpr char kProgram[] = CLEAVE_BINARY_DIR "/server/gateway/cleaved";
// Far beyond what anything here takes: a test that comes to it has failed.
constexpr auto kPatience = 60s;

void SetVector(google::protobuf::RepeatedField<double>* field, double x, double y, double z) {
  field->Clear();
  for (const double value : {x, y, z}) field->Add(value);
}

v1::Scene PulledBox(double length, double side, double cell) {
  v1::Scene scene;
  scene.set_name("pulled box");
  v1::BoxMesh& box = *scene.mutable_mesh()->mutable_box();
  SetVector(box.mutable_size(), length, side, side);
  box.mutable_resolution()->set_layout(v1::MESH_LAYOUT_JITTERED_LATTICE);
  box.mutable_resolution()->set_cell_size(cell);
  v1::Material& material = *scene.add_materials();
  material.set_name("gel");
  material.set_youngs_modulus(1e5);
  material.set_poisson_ratio(0.3);
  material.set_density(1000);
  material.set_tensile_strength(8e3);
  for (const bool right : {false, true}) {
    v1::NodeSet& set = *scene.add_node_sets();
    set.set_name(right ? "right" : "left");
    v1::PlaneSelector& plane = *set.add_select()->mutable_plane();
    SetVector(plane.mutable_point(), right ? length - cell / 2 : cell / 2, 0, 0);
    SetVector(plane.mutable_normal(), right ? 1 : -1, 0, 0);
    v1::Motion& motion = *scene.add_motions();
    motion.set_node_set(set.name());
    if (!right) continue;
    motion.add_keyframes();
    v1::Keyframe& end = *motion.add_keyframes();
    end.set_time(1);
    SetVector(end.mutable_translation(), length / 2, 0, 0);
  }
  return scene;
}

}  // namespace

TestServer::~TestServer() {
  if (pid_ > 0) Stop();
}

void TestServer::Start() {
  const std::string log = directory_ / "log";
  std::vector<std::string> words = {kProgram, "--listen", address(),
                                    "--data", data(),     "--threads-per-worker=1"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_APPEND, 0600);
  const int error = posix_spawn(&pid_, kProgram, &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ASSERT_EQ(error, 0) << kProgram;
}

void TestServer::Kill() {
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

int TestServer::Stop() {
  kill(pid_, SIGTERM);
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::unique_ptr<Client> TestServer::Connect() const {
  absl::StatusOr<std::unique_ptr<Client>> client =
      Client::Connect(address(), std::chrono::milliseconds(kPatience), nullptr);
  EXPECT_TRUE(client.ok()) << client.status() << "\n" << log();
  return client.ok() ? *std::move(client) : nullptr;
}

v1::Scene BreakingBar(int64_t frame_count) {
  v1::Scene scene = PulledBox(0.4, 0.1, 0.05);
  scene.mutable_timing()->set_frames_per_second(100);
  scene.mutable_timing()->set_frame_count(frame_count);
  scene.mutable_timing()->set_steps_per_frame(4);
  scene.mutable_output()->set_keyframe_interval(7);
  scene.mutable_output()->set_checkpoint_interval(5);
  return scene;
}

v1::Scene EndlessFrame() {
  v1::Scene scene = PulledBox(0.4, 0.1, 0.02);
  scene.mutable_timing()->set_frames_per_second(1);
  scene.mutable_timing()->set_frame_count(2);
  scene.mutable_timing()->set_steps_per_frame(100'000);
  return scene;
}

v1::Session Create(Client& client, const std::string& id, const v1::Scene& scene) {
  v1::CreateSessionRequest request;
  request.set_session_id(id);
  *request.mutable_scene() = scene;
  const absl::StatusOr<v1::CreateSessionResponse> created = client.CreateSession(request);
  EXPECT_TRUE(created.ok()) << created.status();
  return created.ok() ? created->session() : v1::Session();
}

std::vector<std::string> RunToEnd(Client& client, const std::string& id) {
  const absl::StatusOr<v1::Session> run = client.RunSession(SessionName(id), {});
  EXPECT_TRUE(run.ok()) << run.status();
  return AllFrames(client, id);
}

std::vector<std::string> AllFrames(Client& client, const std::string& id) {
  FrameStreamOptions options;
  options.session = SessionName(id);
  FrameStream stream(client, options);
  std::vector<std::string> frames;
  while (true) {
    absl::StatusOr<std::optional<StreamedFrame>> frame = stream.Next();
    EXPECT_TRUE(frame.ok()) << frame.status();
    if (!frame.ok() || !frame->has_value()) return frames;
    EXPECT_EQ((*frame)->header.frame, static_cast<int64_t>(frames.size()));
    frames.push_back(std::move((*frame)->bytes));
  }
}

v1::Session WaitFor(Client& client, const std::string& id,
                    const std::function<bool(const v1::Session&)>& wanted) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kPatience);
  v1::WatchSessionRequest request;
  request.set_name(SessionName(id));
  const auto reader = client.stubs().sessions->WatchSession(&context, request);
  v1::Session session;
  while (reader->Read(&session)) {
    if (!wanted(session)) continue;
    context.TryCancel();
    return session;
  }
  ADD_FAILURE() << "the watch ended: " << reader->Finish().error_message();
  return session;
}

bool Rests(const v1::Session& session) {
  return session.state() == v1::SESSION_STATE_IDLE || session.state() == v1::SESSION_STATE_FAILED;
}

}  // namespace cleave
