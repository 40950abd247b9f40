#ifndef CLEAVE_SERVER_GATEWAY_ERRORS_H_
#define CLEAVE_SERVER_GATEWAY_ERRORS_H_

#include <initializer_list>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/base/faults.h"
#include "google/protobuf/message_lite.h"

// Statuses that carry google.rpc details as payloads, for clients that are programs.

namespace cleave {

// ErrorInfo.domain of every error.
inline constexpr absl::string_view kErrorDomain = "cleave.v1";
// What a payload's type URL begins with; the rest is the message's full name.
inline constexpr absl::string_view kTypeUrlPrefix = "type.googleapis.com/";

using ErrorMetadata = std::initializer_list<std::pair<absl::string_view, std::string>>;

// A status with an ErrorInfo of this reason (UPPER_SNAKE_CASE).
absl::Status MakeError(absl::StatusCode code, absl::string_view reason, absl::string_view message,
                       ErrorMetadata metadata = {});

// Adds another detail.
void AddDetail(const google::protobuf::MessageLite& detail, absl::Status& status);

// InvalidArgument with the faults as BadRequest.field_violations, `prefix` before each field: all
// of them, up to the 8 KiB of trailers that gRPC clients accept; ErrorInfo.metadata has their count
// under "faults". Precondition: !faults.ok().
absl::Status MakeBadRequest(absl::string_view reason, absl::string_view prefix,
                            const Faults& faults);
// The same for a single field.
absl::Status MakeBadField(absl::string_view field, absl::string_view description);

// Unavailable: the same call may succeed after this many seconds.
absl::Status MakeRetryLater(absl::string_view reason, absl::string_view message, int seconds);

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_ERRORS_H_
