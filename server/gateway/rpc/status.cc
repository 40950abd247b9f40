#include "server/gateway/rpc/status.h"

#include <string>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "server/gateway/errors.h"

namespace cleave {

grpc::Status ToRpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  absl::Status told = status;
  if (!told.GetPayload(absl::StrCat(kTypeUrlPrefix, "google.rpc.ErrorInfo"))) {
    const std::string message(status.message());
    told = MakeError(status.code(), absl::StatusCodeToString(status.code()), message);
  }
  google::rpc::Status details;
  details.set_code(static_cast<int>(told.code()));
  told.ForEachPayload([&details](absl::string_view type_url, const absl::Cord& payload) {
    google::protobuf::Any& detail = *details.add_details();
    detail.set_type_url(std::string(type_url));
    detail.set_value(std::string(payload));
  });
  // The message travels as the call's own; twice, it would not fit into what clients accept as
  // trailers.
  return {static_cast<grpc::StatusCode>(told.code()), std::string(told.message()),
          details.SerializeAsString()};
}

}  // namespace cleave
