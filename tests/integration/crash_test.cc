// Programs die without warning, and nothing that was committed is lost or made twice.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "client/cpp/client.h"
#include "client/cpp/frame_stream.h"
#include "tests/integration/test_server.h"

namespace cleave {
namespace {

constexpr int64_t kRunFrames = 150;

// What a run gives that nothing disturbs.
const std::vector<std::string>& UndisturbedFrames() {
  static const std::vector<std::string> frames = [] {
    TestServer server;
    const std::unique_ptr<Client> client = server.Connect();
    Create(*client, "undisturbed", BreakingBar(kRunFrames));
    return RunToEnd(*client, "undisturbed");
  }();
  return frames;
}

pid_t WorkerOf(const TestServer& server, const std::string& id) {
  return std::stoi(ReadBytes(server.session_directory(id) + "/owner"));
}

// Takes frames from the stream up to the given one. `told` has the edges that the stream has told
// of, where it was asked for events.
void Take(FrameStream& stream, int64_t last, std::vector<std::string>& frames,
          std::set<int32_t>* told = nullptr) {
  while (static_cast<int64_t>(frames.size()) <= last) {
    absl::StatusOr<std::optional<StreamedFrame>> frame = stream.Next();
    ASSERT_TRUE(frame.ok()) << frame.status();
    ASSERT_TRUE(frame->has_value());
    ASSERT_EQ((*frame)->header.frame, static_cast<int64_t>(frames.size()));
    if (told != nullptr) {
      for (const v1::EdgeBreak& broken : (*frame)->events.edge_breaks())
        ASSERT_TRUE(told->insert(broken.edge()).second) << "edge " << broken.edge() << " again";
      ASSERT_EQ(told->size(), (*frame)->header.broken_edges);
    }
    frames.push_back(std::move((*frame)->bytes));
  }
}

TEST(CrashTest, TheRunThatIsComparedWithBreaksTheBar) {
  ASSERT_EQ(UndisturbedFrames().size(), static_cast<size_t>(kRunFrames + 1));
  const absl::StatusOr<FrameHeader> last = ParseFrameHeader(UndisturbedFrames().back());
  ASSERT_TRUE(last.ok());
  EXPECT_GT(last->broken_edges, 0u);
  EXPECT_GT(last->fragments, 1);
}

TEST(CrashTest, AWorkerKilledTwiceMidRunLosesNoFrameAndNoEventAndRepeatsNone) {
  const std::vector<std::string>& expected = UndisturbedFrames();
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(kRunFrames));
  ASSERT_TRUE(client->RunSession("sessions/bar", {}).ok());
  FrameStreamOptions options;
  options.session = "sessions/bar";
  options.events = true;
  FrameStream stream(*client, options);
  std::vector<std::string> frames;
  std::set<int32_t> told;
  for (const int64_t frame : {12, 27}) {
    Take(stream, frame, frames, &told);
    if (HasFatalFailure()) return;
    ASSERT_EQ(kill(WorkerOf(server, "bar"), SIGKILL), 0);
    ASSERT_LT(client->GetSession("sessions/bar")->head_frame(), kRunFrames);
  }
  Take(stream, kRunFrames, frames, &told);
  if (HasFatalFailure()) return;
  EXPECT_FALSE((*stream.Next()).has_value());
  EXPECT_EQ(frames, expected);
  EXPECT_GT(told.size(), 0u);
  EXPECT_THAT(server.log(), testing::HasSubstr("worker_ended session=bar how=\"signal 9\""));
}

TEST(CrashTest, AGatewayKilledMidStreamGoesOnWhereItWasWhenItIsBack) {
  const std::vector<std::string>& expected = UndisturbedFrames();
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  const v1::Session created = Create(*client, "bar", BreakingBar(kRunFrames));
  ASSERT_TRUE(client->RunSession("sessions/bar", {}).ok());
  FrameStreamOptions options;
  options.session = "sessions/bar";
  options.events = true;
  FrameStream stream(*client, options);
  std::vector<std::string> frames;
  std::set<int32_t> told;
  Take(stream, 15, frames, &told);
  if (HasFatalFailure()) return;
  server.Kill();
  // A line a frame: the run was not over yet, or this test would show nothing.
  const std::string reports = ReadBytes(server.session_directory("bar") + "/reports.jsonl");
  ASSERT_LT(std::count(reports.begin(), reports.end(), '\n'), kRunFrames);
  server.Start();
  // The same stream: the client goes on behind the last frame that it has.
  Take(stream, kRunFrames, frames, &told);
  if (HasFatalFailure()) return;
  EXPECT_FALSE((*stream.Next()).has_value());
  EXPECT_EQ(frames, expected);
  EXPECT_EQ(AllFrames(*client, "bar"), expected);
  EXPECT_EQ(client->GetSession("sessions/bar")->uid(), created.uid());
}

TEST(CrashTest, AServerThatIsStoppedMidRunSavesAndGoesOnByItself) {
  const std::vector<std::string>& expected = UndisturbedFrames();
  TestServer server;
  {
    const std::unique_ptr<Client> client = server.Connect();
    Create(*client, "bar", BreakingBar(kRunFrames));
    ASSERT_TRUE(client->RunSession("sessions/bar", {}).ok());
    WaitFor(*client, "bar", [](const v1::Session& session) { return session.head_frame() >= 8; });
  }
  EXPECT_EQ(server.Stop(), 0) << server.log();
  server.Start();
  const std::unique_ptr<Client> client = server.Connect();
  EXPECT_EQ(AllFrames(*client, "bar"), expected);
}

TEST(CrashTest, APausedSessionStaysPausedAcrossARestartOfTheServer) {
  TestServer server;
  int64_t head = 0;
  {
    const std::unique_ptr<Client> client = server.Connect();
    Create(*client, "bar", BreakingBar(kRunFrames));
    ASSERT_TRUE(client->RunSession("sessions/bar", {}).ok());
    WaitFor(*client, "bar", [](const v1::Session& session) { return session.head_frame() >= 5; });
    const absl::StatusOr<v1::Session> paused = client->PauseSession("sessions/bar", false);
    ASSERT_TRUE(paused.ok()) << paused.status();
    EXPECT_EQ(paused->state(), v1::SESSION_STATE_IDLE);
    head = paused->head_frame();
  }
  server.Kill();
  server.Start();
  const std::unique_ptr<Client> client = server.Connect();
  const absl::StatusOr<v1::Session> session = client->GetSession("sessions/bar");
  ASSERT_TRUE(session.ok()) << session.status();
  EXPECT_EQ(session->state(), v1::SESSION_STATE_IDLE);
  EXPECT_EQ(session->head_frame(), head);
  EXPECT_EQ(RunToEnd(*client, "bar"), UndisturbedFrames());
}

// Runs cleave-worker alone on a directory; returns its exit code, or -1 when a signal ended it.
int RunWorker(const std::string& directory, pid_t* running = nullptr) {
  const std::string program = CLEAVE_BINARY_DIR "/server/worker/cleave-worker";
  const char* const arguments[] = {program.c_str(), directory.c_str(), nullptr};
  pid_t pid = -1;
  EXPECT_EQ(posix_spawn(&pid, program.c_str(), nullptr, nullptr,
                        const_cast<char* const*>(arguments), environ),
            0);
  if (running != nullptr) {
    *running = pid;
    return 0;
  }
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(CrashTest, AWorkerAloneRunsADirectoryToItsEndAcrossTerminations) {
  TestServer server;
  {
    const std::unique_ptr<Client> client = server.Connect();
    Create(*client, "bar", BreakingBar(kRunFrames));
    WaitFor(*client, "bar", Rests);
  }
  ASSERT_EQ(server.Stop(), 0);
  const std::string directory = server.session_directory("bar");
  for (int i = 0; i < 3; ++i) {
    // Wherever it is when the signal comes: loading, catching up, in a frame.
    pid_t pid = -1;
    RunWorker(directory, &pid);
    kill(pid, SIGTERM);
    int status = 0;
    waitpid(pid, &status, 0);
  }
  EXPECT_EQ(RunWorker(directory), 0);
  EXPECT_EQ(RunWorker(directory), 0);  // nothing is left to do
  server.Start();
  EXPECT_EQ(AllFrames(*server.Connect(), "bar"), UndisturbedFrames());
}

TEST(CrashTest, ADirectoryThatIsNoSessionEndsAWorkerWithAnError) {
  TemporaryDirectory directory;
  EXPECT_EQ(RunWorker(directory.path()), 1);
  EXPECT_EQ(RunWorker("/nowhere"), 1);
}

TEST(CrashTest, ADamagedCheckpointAndATornJournalOnlyCostTime) {
  const std::vector<std::string>& expected = UndisturbedFrames();
  TestServer server;
  {
    const std::unique_ptr<Client> client = server.Connect();
    Create(*client, "bar", BreakingBar(kRunFrames));
    v1::RunGoal goal;
    goal.set_until_frame(20);
    ASSERT_TRUE(client->RunSession("sessions/bar", goal).ok());
    WaitFor(*client, "bar", [](const v1::Session& session) {
      return Rests(session) && session.head_frame() == 20;
    });
  }
  ASSERT_EQ(server.Stop(), 0);
  const std::string directory = server.session_directory("bar");
  WriteBytes(directory + "/checkpoints/0000000020.checkpoint", "torn");
  WriteBytes(directory + "/journal", ReadBytes(directory + "/journal") + "\x20\x01");
  server.Start();
  const std::unique_ptr<Client> client = server.Connect();
  EXPECT_EQ(RunToEnd(*client, "bar"), expected);
}

}  // namespace
}  // namespace cleave
