#include "client/cli/exit_code.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

TEST(ExitCode, EveryKindOfFailureHasItsNumber) {
  EXPECT_EQ(ExitCodeOf(absl::OkStatus(), 0), ExitCode::kOk);
  EXPECT_EQ(ExitCodeOf(absl::InvalidArgumentError(""), 0), ExitCode::kInvalidInput);
  EXPECT_EQ(ExitCodeOf(absl::DataLossError(""), 0), ExitCode::kInvalidInput);
  EXPECT_EQ(ExitCodeOf(absl::UnavailableError(""), 0), ExitCode::kUnreachable);
  EXPECT_EQ(ExitCodeOf(absl::NotFoundError(""), 0), ExitCode::kNotFound);
  EXPECT_EQ(ExitCodeOf(absl::FailedPreconditionError(""), 0), ExitCode::kState);
  EXPECT_EQ(ExitCodeOf(absl::ResourceExhaustedError(""), 0), ExitCode::kLimit);
  EXPECT_EQ(ExitCodeOf(absl::InternalError(""), 0), ExitCode::kOther);
}

TEST(ExitCode, FailedSimulationIsNotAnAbortedCall) {
  EXPECT_EQ(ExitCodeOf(SimulationFailed("diverged"), 0), ExitCode::kSimulationFailed);
  EXPECT_EQ(ExitCodeOf(absl::AbortedError("diverged"), 0), ExitCode::kState);
}

TEST(ExitCode, SignalTellsInterruptedFromTerminated) {
  EXPECT_EQ(ExitCodeOf(absl::CancelledError(""), SIGINT), ExitCode::kInterrupted);
  EXPECT_EQ(ExitCodeOf(absl::CancelledError(""), SIGTERM), ExitCode::kTerminated);
}

TEST(ExitCode, HelpListsEveryNumber) {
  for (const ExitCode code :
       {ExitCode::kOk, ExitCode::kOther, ExitCode::kUsage, ExitCode::kInvalidInput,
        ExitCode::kUnreachable, ExitCode::kSimulationFailed, ExitCode::kNotFound, ExitCode::kState,
        ExitCode::kLimit, ExitCode::kInterrupted})
    EXPECT_THAT(ExitCodeHelp(),
                testing::HasSubstr(absl::StrCat("\n  ", static_cast<int>(code), " ")));
  EXPECT_THAT(ExitCodeHelp(), testing::HasSubstr("143"));
}

}  // namespace
}  // namespace cleave
