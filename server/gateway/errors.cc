#include "server/gateway/errors.h"

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "google/rpc/error_details.pb.h"

namespace cleave {
namespace {

// Trailers hold the details in base64, and the message; gRPC refuses more than 8 KiB of them.
constexpr size_t kMaxDetailBytes = 4500;
constexpr size_t kMaxMessageBytes = 800;
constexpr size_t kMaxFaultBytes = 400;

// The text, or its first characters: never half a UTF-8 character, which no client would parse.
absl::string_view Cut(absl::string_view text, size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  while (max_bytes > 0 && (text[max_bytes] & 0xC0) == 0x80) --max_bytes;
  return text.substr(0, max_bytes);
}

}  // namespace

absl::Status MakeError(absl::StatusCode code, absl::string_view reason, absl::string_view message,
                       ErrorMetadata metadata) {
  absl::Status status(code, Cut(message, 2 * kMaxMessageBytes));
  google::rpc::ErrorInfo info;
  info.set_reason(std::string(reason));
  info.set_domain(std::string(kErrorDomain));
  for (const auto& [key, value] : metadata) (*info.mutable_metadata())[std::string(key)] = value;
  AddDetail(info, status);
  return status;
}

void AddDetail(const google::protobuf::MessageLite& detail, absl::Status& status) {
  status.SetPayload(absl::StrCat(kTypeUrlPrefix, detail.GetTypeName()),
                    absl::Cord(detail.SerializeAsString()));
}

absl::Status MakeBadRequest(absl::string_view reason, absl::string_view prefix,
                            const Faults& faults) {
  google::rpc::BadRequest details;
  std::string message = absl::StrCat(faults.error_count(), " fault",
                                     faults.error_count() == 1 ? "" : "s", " in the request");
  size_t bytes = 0;
  for (const Fault& fault : faults.errors()) {
    const std::string field(Cut(absl::StrCat(prefix, fault.field), kMaxFaultBytes));
    const std::string description(Cut(fault.description, kMaxFaultBytes));
    bytes += field.size() + description.size() + 8;
    if (bytes > kMaxDetailBytes) break;
    if (message.size() < kMaxMessageBytes) absl::StrAppend(&message, "\n", field, ": ", description);
    google::rpc::BadRequest::FieldViolation& violation = *details.add_field_violations();
    violation.set_field(field);
    violation.set_description(description);
  }
  absl::Status status = MakeError(absl::StatusCode::kInvalidArgument, reason, message,
                                  {{"faults", absl::StrCat(faults.error_count())}});
  AddDetail(details, status);
  return status;
}

absl::Status MakeBadField(absl::string_view field, absl::string_view description) {
  Faults faults;
  faults.Error(field, description);
  return MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
}

absl::Status MakeRetryLater(absl::string_view reason, absl::string_view message, int seconds) {
  absl::Status status = MakeError(absl::StatusCode::kUnavailable, reason, message);
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(seconds);
  AddDetail(retry, status);
  return status;
}

}  // namespace cleave
