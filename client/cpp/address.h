#ifndef CLEAVE_CLIENT_CPP_ADDRESS_H_
#define CLEAVE_CLIENT_CPP_ADDRESS_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cleave {

// The longest path that a unix socket's address holds on Linux (sun_path without its final zero).
inline constexpr size_t kMaxSocketPathBytes = 107;

// The gRPC target for an address that a person typed: unix:PATH, HOST:PORT or [IPV6]:PORT.
// Errors: InvalidArgument that names the part at fault and shows both forms.
absl::StatusOr<std::string> ParseAddress(absl::string_view address);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_ADDRESS_H_
