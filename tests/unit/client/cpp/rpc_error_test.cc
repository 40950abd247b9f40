#include "client/cpp/rpc_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace cleave {
namespace {

using testing::HasSubstr;

TEST(StatusFromRpc, FieldFaultsBecomeALineEach) {
  google::rpc::BadRequest bad_request;
  auto* violation = bad_request.add_field_violations();
  violation->set_field("scene.materials[2].poisson_ratio");
  violation->set_description("0.52 is outside [0, 0.4999]");
  violation = bad_request.add_field_violations();
  violation->set_field("session_id");
  violation->set_description("\"A\" is not [a-z][a-z0-9-]{2,62}");
  google::rpc::ErrorInfo info;
  info.set_reason("INVALID_SCENE");
  google::rpc::Status rich;
  rich.add_details()->PackFrom(bad_request);
  rich.add_details()->PackFrom(info);
  const absl::Status status = StatusFromRpc(
      grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, "2 faults", rich.SerializeAsString()),
      "creating the session");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(),
            "materials[2].poisson_ratio: 0.52 is outside [0, 0.4999]\n"
            "session_id: \"A\" is not [a-z][a-z0-9-]{2,62}");
  EXPECT_EQ(ReasonOf(status), "INVALID_SCENE");
  ASSERT_EQ(FaultsOf(status).size(), 2u);
  EXPECT_EQ(FaultsOf(status)[0].field, "materials[2].poisson_ratio");
}

TEST(StatusFromRpc, SaysWhatWasTriedAndWhy) {
  EXPECT_EQ(StatusFromRpc(grpc::Status(grpc::StatusCode::NOT_FOUND, "no session a"), "looking up a")
                .message(),
            "looking up a: no session a");
  EXPECT_THAT(
      std::string(StatusFromRpc(grpc::Status(grpc::StatusCode::UNIMPLEMENTED, ""), "a").message()),
      HasSubstr("different versions"));
  EXPECT_THAT(
      std::string(StatusFromRpc(grpc::Status(grpc::StatusCode::UNAVAILABLE, "x"), "a").message()),
      HasSubstr("cannot be reached"));
  EXPECT_TRUE(StatusFromRpc(grpc::Status::OK, "a").ok());
}

TEST(StatusFromRpc, DamagedDetailsAreNoDetails) {
  const absl::Status status = StatusFromRpc(
      grpc::Status(grpc::StatusCode::INTERNAL, "oops", "\xff\xff not a message"), "calling");
  EXPECT_EQ(status.message(), "calling: oops");
  EXPECT_TRUE(FaultsOf(status).empty());
  EXPECT_EQ(ReasonOf(status), "");
  EXPECT_FALSE(RetryDelayOf(status).has_value());
}

}  // namespace
}  // namespace cleave
