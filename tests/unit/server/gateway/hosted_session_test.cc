#include "server/gateway/hosted_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>

#include "server/session/config.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

class HostedSessionTest : public testing::Test {
 protected:
  std::shared_ptr<HostedSession> Make(const std::string& program) {
    workers_.program = program;
    worker::v1::SessionConfig config;
    config.set_session_id("bar");
    EXPECT_TRUE(CreateSessionDirectory({directory_ / "bar"}, config).ok());
    auto session =
        std::make_shared<HostedSession>(SessionPaths{directory_ / "bar"}, config, workers_);
    EXPECT_TRUE(session->Load().ok());
    return session;
  }
  // Waits for a state by watching, as calls do.
  HostedSession::State WaitFor(HostedSession& session, v1::SessionState wanted) {
    std::promise<void> reached;
    std::once_flag once;
    const auto look = [&] {
      if (session.state().state == wanted) std::call_once(once, [&] { reached.set_value(); });
    };
    const auto observer = session.Observe(look);
    look();
    EXPECT_EQ(reached.get_future().wait_for(std::chrono::seconds(60)), std::future_status::ready);
    session.Forget(observer);
    return session.state();
  }

  TemporaryDirectory directory_;
  WorkerOptions workers_;
};

TEST_F(HostedSessionTest, ANewSessionRestsWithoutAWorker) {
  const auto session = Make("/bin/false");
  EXPECT_EQ(session->state().state, v1::SESSION_STATE_IDLE);
  EXPECT_EQ(session->state().head_frame, -1);
  EXPECT_FALSE(session->state().active);
}

TEST_F(HostedSessionTest, AWorkerThatEndsAgainAndAgainFailsTheSessionWithAReason) {
  const auto session = Make("/bin/false");
  ASSERT_TRUE(session->StartWorker().ok());
  const HostedSession::State state = WaitFor(*session, v1::SESSION_STATE_FAILED);
  EXPECT_EQ(state.error.reason(), "WORKER_LOST");
  EXPECT_THAT(state.error.message(), testing::HasSubstr("exit code 1"));
  EXPECT_FALSE(state.active);
}

TEST_F(HostedSessionTest, ACommandToAWorkerThatEndsIsAnsweredUnavailable) {
  const auto session = Make("/bin/false");
  std::promise<absl::Status> answered;
  v1::RunGoal goal;
  goal.set_until_frame(5);
  session->Run(goal, "", [&](const absl::Status& status) { answered.set_value(status); });
  const absl::Status status = answered.get_future().get();
  EXPECT_TRUE(absl::IsUnavailable(status)) << status;
}

TEST_F(HostedSessionTest, AProgramThatIsNotThereIsAnErrorOfTheCall) {
  const auto session = Make("/nowhere/cleave-worker");
  EXPECT_FALSE(session->StartWorker().ok());
}

TEST_F(HostedSessionTest, APauseWithoutAWorkerHasNothingToDo) {
  const auto session = Make("/bin/false");
  std::promise<absl::Status> answered;
  session->Pause(true, [&](const absl::Status& status) { answered.set_value(status); });
  EXPECT_TRUE(answered.get_future().get().ok());
}

TEST_F(HostedSessionTest, ADeletedSessionTakesNoCommands) {
  const auto session = Make("/bin/false");
  bool removable = false;
  session->Delete([&] { removable = true; });
  EXPECT_TRUE(removable);
  std::promise<absl::Status> answered;
  session->Run({}, "", [&](const absl::Status& status) { answered.set_value(status); });
  EXPECT_TRUE(absl::IsNotFound(answered.get_future().get()));
}

}  // namespace
}  // namespace cleave
