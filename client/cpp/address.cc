#include "client/cpp/address.h"

#include <cstdint>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"

namespace cleave {
namespace {

absl::Status Wrong(absl::string_view address, absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat("server address \"", address, "\": ", why,
                                                 "; use HOST:PORT or unix:/path/to/socket"));
}

}  // namespace

absl::StatusOr<std::string> ParseAddress(absl::string_view address) {
  absl::string_view rest = address;
  if (absl::ConsumePrefix(&rest, "unix:")) {
    if (absl::ConsumePrefix(&rest, "//") && !absl::StartsWith(rest, "/"))
      return Wrong(address, "the path after unix:// must begin with /");
    if (rest.empty()) return Wrong(address, "the socket's path is missing");
    if (rest.size() > kMaxSocketPathBytes)
      return Wrong(address, absl::StrCat("a socket's path has at most ", kMaxSocketPathBytes,
                                         " bytes, this one has ", rest.size()));
    return absl::StrCat("unix:", rest);
  }
  if (absl::StrContains(address, "://")) return Wrong(address, "a URL is not an address");
  const size_t colon = address.rfind(':');
  if (colon == absl::string_view::npos) return Wrong(address, "the port is missing");
  const absl::string_view host = address.substr(0, colon);
  const absl::string_view port = address.substr(colon + 1);
  uint32_t number = 0;
  if (!absl::SimpleAtoi(port, &number) || number == 0 || number > 65535)
    return Wrong(address, absl::StrCat("port \"", port, "\" is outside [1, 65535]"));
  if (host.empty()) return Wrong(address, "the host is missing");
  const bool bracketed = host.front() == '[' && host.back() == ']';
  if (!bracketed && absl::StrContains(host, ":"))
    return Wrong(address, "an IPv6 address stands in brackets: [::1]:PORT");
  if (host.find_first_of(" /\t") != absl::string_view::npos)
    return Wrong(address, "the host holds a character that no host has");
  return absl::StrCat("dns:///", host, ":", number);
}

}  // namespace cleave
