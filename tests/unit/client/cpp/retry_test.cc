#include "client/cpp/retry.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "absl/strings/cord.h"
#include "google/rpc/error_details.pb.h"

namespace cleave {
namespace {

using std::chrono::milliseconds;

absl::Status WithRetryInfo(absl::Status status, int64_t seconds) {
  google::rpc::RetryInfo info;
  info.mutable_retry_delay()->set_seconds(seconds);
  status.SetPayload("type.googleapis.com/google.rpc.RetryInfo",
                    absl::Cord(info.SerializeAsString()));
  return status;
}

TEST(RetryDelay, OnlyUnavailableIsRepeatedBlindly) {
  const RetryPolicy policy;
  EXPECT_TRUE(RetryDelay(policy, 1, absl::UnavailableError("")).has_value());
  EXPECT_FALSE(RetryDelay(policy, 1, absl::OkStatus()).has_value());
  for (const auto code : {absl::StatusCode::kInternal, absl::StatusCode::kDeadlineExceeded,
                          absl::StatusCode::kAborted, absl::StatusCode::kInvalidArgument,
                          absl::StatusCode::kResourceExhausted})
    EXPECT_FALSE(RetryDelay(policy, 1, absl::Status(code, "")).has_value());
}

TEST(RetryDelay, DelaysDoubleUpToTheLargest) {
  const RetryPolicy policy;
  const absl::Status cut = absl::UnavailableError("");
  EXPECT_EQ(*RetryDelay(policy, 1, cut), milliseconds(200));
  EXPECT_EQ(*RetryDelay(policy, 2, cut), milliseconds(400));
  EXPECT_EQ(*RetryDelay(policy, 6, cut), milliseconds(5000));
  EXPECT_FALSE(RetryDelay(policy, policy.max_attempts, cut).has_value());
}

TEST(RetryDelay, ServerMaySayWhen) {
  const RetryPolicy policy;
  EXPECT_EQ(*RetryDelay(policy, 1, WithRetryInfo(absl::ResourceExhaustedError(""), 2)),
            milliseconds(2000));
  EXPECT_EQ(*RetryDelay(policy, 1, WithRetryInfo(absl::UnavailableError(""), 7)),
            milliseconds(7000));
}

}  // namespace
}  // namespace cleave
