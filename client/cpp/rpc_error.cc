#include "client/cpp/rpc_error.h"

#include <cstdint>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace cleave {
namespace {

constexpr char kTypePrefix[] = "type.googleapis.com/google.rpc.";

template <typename Detail>
std::optional<Detail> DetailOf(const absl::Status& status, absl::string_view name) {
  const absl::optional<absl::Cord> payload = status.GetPayload(absl::StrCat(kTypePrefix, name));
  Detail detail;
  if (!payload.has_value() || !detail.ParseFromString(std::string(*payload))) return std::nullopt;
  return detail;
}

std::string Explanation(const grpc::Status& status, absl::string_view call) {
  // A server that cannot parse a request answers Unimplemented without a word.
  if (status.error_code() == grpc::StatusCode::UNIMPLEMENTED && status.error_message().empty())
    return absl::StrCat(call, ": the server does not know this call or cannot read the request; ",
                        "client and server are of different versions");
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE)
    return absl::StrCat(call, ": the server cannot be reached (", status.error_message(), ")");
  if (status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED)
    return absl::StrCat(call, ": the server did not answer in time");
  if (status.error_message().empty())
    return absl::StrCat(
        call, ": ", absl::StatusCodeToString(static_cast<absl::StatusCode>(status.error_code())));
  return absl::StrCat(call, ": ", status.error_message());
}

}  // namespace

absl::Status StatusFromRpc(const grpc::Status& status, absl::string_view call) {
  if (status.ok()) return absl::OkStatus();
  google::rpc::Status rich;
  if (!rich.ParseFromString(status.error_details())) rich.Clear();
  std::vector<Fault> faults;
  for (const google::protobuf::Any& detail : rich.details()) {
    google::rpc::BadRequest bad_request;
    if (!detail.UnpackTo(&bad_request)) continue;
    for (const auto& violation : bad_request.field_violations())
      faults.push_back(
          {std::string(absl::StripPrefix(violation.field(), "scene.")), violation.description()});
  }
  const std::string message =
      faults.empty() ? Explanation(status, call)
                     : absl::StrJoin(faults, "\n", [](std::string* out, const Fault& fault) {
                         if (!fault.field.empty()) absl::StrAppend(out, fault.field, ": ");
                         absl::StrAppend(out, fault.description);
                       });
  absl::Status result(static_cast<absl::StatusCode>(status.error_code()), message);
  for (const google::protobuf::Any& detail : rich.details())
    result.SetPayload(detail.type_url(), absl::Cord(detail.value()));
  return result;
}

std::vector<Fault> FaultsOf(const absl::Status& status) {
  std::vector<Fault> faults;
  const auto bad_request = DetailOf<google::rpc::BadRequest>(status, "BadRequest");
  if (!bad_request.has_value()) return faults;
  for (const auto& violation : bad_request->field_violations())
    faults.push_back(
        {std::string(absl::StripPrefix(violation.field(), "scene.")), violation.description()});
  return faults;
}

std::string ReasonOf(const absl::Status& status) {
  const auto info = DetailOf<google::rpc::ErrorInfo>(status, "ErrorInfo");
  return info.has_value() ? info->reason() : "";
}

std::optional<std::chrono::milliseconds> RetryDelayOf(const absl::Status& status) {
  const auto retry = DetailOf<google::rpc::RetryInfo>(status, "RetryInfo");
  if (!retry.has_value()) return std::nullopt;
  const int64_t seconds = retry->retry_delay().seconds();
  if (seconds < 0 || seconds > 3600) return std::nullopt;
  return std::chrono::milliseconds(seconds * 1000 + retry->retry_delay().nanos() / 1'000'000);
}

}  // namespace cleave
