#include "server/worker/controller.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <memory>

#include "server/control/message_socket.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

// A controller on a fresh journal, and the gateway's end of its socket.
class ControllerTest : public testing::Test {
 protected:
  void SetUp() override { Start(); }

  void Start() {
    auto ends = MakeSocketPair();
    ASSERT_TRUE(ends.ok());
    gateway_ = std::move(ends->first);
    control_ = std::make_unique<Controller>(std::move(ends->second));
    const absl::StatusOr<JournalContents> journal = ReadJournal(directory_ / "journal");
    ASSERT_TRUE(journal.ok());
    absl::StatusOr<JournalWriter> writer = JournalWriter::Open(directory_ / "journal", *journal);
    ASSERT_TRUE(writer.ok());
    ASSERT_TRUE(control_->Start(std::move(*writer), SummariseJournal(journal->records)).ok());
  }

  void SendCommand(const worker::v1::Command& command) {
    ASSERT_TRUE(SendMessage(gateway_, command).ok());
  }
  void SendRun(int64_t until_frame, const std::string& request_id = "") {
    worker::v1::Command command;
    command.mutable_run()->mutable_goal()->set_until_frame(until_frame);
    command.mutable_run()->set_request_id(request_id);
    SendCommand(command);
  }
  void SendPause(bool abort_step) {
    worker::v1::Command command;
    command.mutable_pause()->set_abort_step(abort_step);
    SendCommand(command);
  }
  worker::v1::Event Receive() {
    worker::v1::Event event;
    EXPECT_TRUE(ReceiveMessage(gateway_, event).ok());
    return event;
  }
  int Acknowledged() {
    const worker::v1::Event event = Receive();
    EXPECT_TRUE(event.has_acknowledged());
    return event.acknowledged().code();
  }
  v1::SessionState State() {
    const worker::v1::Event event = Receive();
    EXPECT_TRUE(event.has_status());
    return event.status().state();
  }
  JournalState Journal() { return SummariseJournal(ReadJournal(directory_ / "journal")->records); }

  TemporaryDirectory directory_;
  FileDescriptor gateway_;
  std::unique_ptr<Controller> control_;
};

TEST_F(ControllerTest, AnAcknowledgedRunIsInTheJournalAndInForce) {
  SendRun(5);
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(Journal().goal->goal().until_frame(), 5);
  EXPECT_EQ(*control_->Take(0), Order::kAdvance);
  EXPECT_EQ(State(), v1::SESSION_STATE_RUNNING);
}

TEST_F(ControllerTest, AGoalThatTheHeadHasReachedEndsInTheJournal) {
  SendRun(5);
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(*control_->Take(5), Order::kRest);
  EXPECT_EQ(State(), v1::SESSION_STATE_IDLE);
  EXPECT_FALSE(Journal().goal.has_value());
}

TEST_F(ControllerTest, ARepeatedRequestStartsNothingNewAlsoAfterARestart) {
  SendRun(5, "once");
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(*control_->Take(5), Order::kRest);
  control_.reset();
  Start();
  SendRun(9, "once");
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(*control_->Take(5), Order::kRest);
}

TEST_F(ControllerTest, ARunWithoutAFrameIsRefused) {
  SendRun(0);
  EXPECT_EQ(Acknowledged(), static_cast<int>(absl::StatusCode::kInvalidArgument));
  EXPECT_EQ(*control_->Take(0), Order::kRest);
}

TEST_F(ControllerTest, APauseLetsTheFrameInWorkFinish) {
  SendRun(5);
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(*control_->Take(0), Order::kAdvance);
  SendPause(false);
  Receive();
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_FALSE(control_->stop().requested());
  EXPECT_EQ(*control_->Take(1), Order::kRest);
}

TEST_F(ControllerTest, AnAbortingPauseStopsTheFrameInWorkAndALaterRunGoesOn) {
  SendRun(5);
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(*control_->Take(0), Order::kAdvance);
  EXPECT_EQ(State(), v1::SESSION_STATE_RUNNING);
  SendPause(true);
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_TRUE(control_->stop().requested());
  SendRun(6);
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(*control_->Take(0), Order::kAdvance);
  EXPECT_FALSE(control_->stop().requested());
}

TEST_F(ControllerTest, AnUnfinishedGoalIsTakenUpAfterARestart) {
  SendRun(5);
  EXPECT_EQ(Acknowledged(), 0);
  control_.reset();
  Start();
  EXPECT_EQ(*control_->Take(3), Order::kAdvance);
}

TEST_F(ControllerTest, AGatewayThatIsGoneMeansQuitAndKeepsTheGoal) {
  SendRun(5);
  EXPECT_EQ(Acknowledged(), 0);
  gateway_.Close();
  control_->Wait();  // for the run
  while (*control_->Take(0) != Order::kQuit) control_->Wait();
  EXPECT_TRUE(control_->stop().requested());
  EXPECT_FALSE(control_->KeepGoing());
  EXPECT_TRUE(Journal().goal.has_value());
}

TEST_F(ControllerTest, GarbageOnTheSocketMeansQuit) {
  ASSERT_EQ(write(gateway_.get(), "\xff\xff\xff\xff", 4), 4);
  control_->Wait();
  EXPECT_EQ(*control_->Take(0), Order::kQuit);
}

TEST_F(ControllerTest, AFailureIsJournaledAndReportedUntilTheNextRun) {
  SendRun(5);
  EXPECT_EQ(Acknowledged(), 0);
  v1::Error error;
  error.set_reason("SOLVER_DIVERGED");
  error.set_code(10);
  control_->Failed(error);
  EXPECT_EQ(State(), v1::SESSION_STATE_FAILED);
  EXPECT_EQ(Journal().failure->error().reason(), "SOLVER_DIVERGED");
  EXPECT_FALSE(control_->failure().ok());
  EXPECT_EQ(*control_->Take(2), Order::kRest);
  EXPECT_EQ(State(), v1::SESSION_STATE_FAILED);
  SendRun(6);
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(*control_->Take(2), Order::kAdvance);
  EXPECT_EQ(State(), v1::SESSION_STATE_RUNNING);
}

TEST_F(ControllerTest, ARunStopsAfterTheFrameThatBreaksWhereAskedTo) {
  worker::v1::Command command;
  command.mutable_run()->mutable_goal()->set_until_frame(50);
  command.mutable_run()->mutable_goal()->set_stop_on_fracture(true);
  SendCommand(command);
  EXPECT_EQ(Acknowledged(), 0);
  control_->Committed(1, {}, false);
  EXPECT_EQ(*control_->Take(1), Order::kAdvance);
  control_->Committed(2, {}, true);
  EXPECT_EQ(*control_->Take(2), Order::kRest);
}

TEST_F(ControllerTest, ASpentWallBudgetEndsTheRunAtTheNextFrame) {
  worker::v1::Command command;
  command.mutable_run()->mutable_goal()->set_until_frame(50);
  command.mutable_run()->mutable_goal()->mutable_wall_budget()->set_nanos(1);
  SendCommand(command);
  EXPECT_EQ(Acknowledged(), 0);
  EXPECT_EQ(*control_->Take(1), Order::kRest);
}

}  // namespace
}  // namespace cleave
