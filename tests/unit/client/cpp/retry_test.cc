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

TEST(CallWithRetry, RepeatsUntilTheAnswer) {
  RetryPolicy policy;
  policy.first_delay = milliseconds(0);
  int calls = 0;
  const absl::Status status = CallWithRetry(policy, "calling", nullptr, [&](grpc::ClientContext&) {
    return ++calls < 3 ? grpc::Status(grpc::StatusCode::UNAVAILABLE, "") : grpc::Status::OK;
  });
  EXPECT_TRUE(status.ok()) << status;
  EXPECT_EQ(calls, 3);
}

TEST(CallWithRetry, StopRequestEndsTheWaiting) {
  RetryPolicy policy;
  policy.first_delay = std::chrono::hours(1);
  policy.max_delay = std::chrono::hours(1);
  StopFlag stop;
  int calls = 0;
  const absl::Status status = CallWithRetry(policy, "calling", &stop, [&](grpc::ClientContext&) {
    ++calls;
    stop.Request();
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "");
  });
  EXPECT_TRUE(absl::IsCancelled(status)) << status;
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace cleave
