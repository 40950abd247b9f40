#include "client/cpp/call_with_retry.h"

#include <gtest/gtest.h>

#include <chrono>

namespace cleave {
namespace {

using std::chrono::milliseconds;

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
