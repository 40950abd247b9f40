#include "server/gateway/errors.h"

#include <gtest/gtest.h>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "google/rpc/error_details.pb.h"

namespace cleave {
namespace {

template <typename Detail>
Detail DetailOf(const absl::Status& status) {
  Detail detail;
  const auto payload = status.GetPayload(absl::StrCat(kTypeUrlPrefix, detail.GetTypeName()));
  EXPECT_TRUE(payload.has_value());
  EXPECT_TRUE(detail.ParseFromString(std::string(payload.value_or(absl::Cord()))));
  return detail;
}

TEST(ErrorsTest, AnErrorCarriesItsReason) {
  const absl::Status status =
      MakeError(absl::StatusCode::kAborted, "HEAD_MOVED", "text", {{"head_frame", "7"}});
  EXPECT_TRUE(absl::IsAborted(status));
  const auto info = DetailOf<google::rpc::ErrorInfo>(status);
  EXPECT_EQ(info.reason(), "HEAD_MOVED");
  EXPECT_EQ(info.domain(), "cleave.v1");
  EXPECT_EQ(info.metadata().at("head_frame"), "7");
}

TEST(ErrorsTest, EveryFaultIsAFieldViolation) {
  Faults faults;
  faults.Error("a", "is wrong");
  faults.Error("b[2].c", "is wrong too");
  const auto details = DetailOf<google::rpc::BadRequest>(MakeBadRequest("BAD", "scene.", faults));
  ASSERT_EQ(details.field_violations_size(), 2);
  EXPECT_EQ(details.field_violations(1).field(), "scene.b[2].c");
}

TEST(ErrorsTest, ManyLongFaultsStayBelowWhatTrailersHoldAndAreCounted) {
  Faults faults;
  // Two-byte characters: cutting within one would make a message that no client parses.
  std::string long_text;
  for (int i = 0; i < 1000; ++i) long_text += "\xc3\xa4";
  for (int i = 0; i < 1000; ++i) faults.Error(absl::StrCat("field", i), "x" + long_text);
  const absl::Status status = MakeBadRequest("BAD", "", faults);
  const auto details = DetailOf<google::rpc::BadRequest>(status);
  EXPECT_LT(details.ByteSizeLong(), 5000u);
  EXPECT_LT(status.message().size(), 2000u);
  EXPECT_GE(details.field_violations_size(), 5);
  EXPECT_EQ(DetailOf<google::rpc::ErrorInfo>(status).metadata().at("faults"), "1000");
}

TEST(ErrorsTest, ARetryableErrorSaysWhen) {
  const absl::Status status = MakeRetryLater("DRAINING", "later", 3);
  EXPECT_TRUE(absl::IsUnavailable(status));
  EXPECT_EQ(DetailOf<google::rpc::RetryInfo>(status).retry_delay().seconds(), 3);
}

}  // namespace
}  // namespace cleave
