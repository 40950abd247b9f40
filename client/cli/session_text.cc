#include "client/cli/session_text.h"

#include <google/protobuf/util/json_util.h>

#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"
#include "absl/strings/strip.h"
#include "client/cpp/client.h"

namespace cleave {

std::string StateText(v1::SessionState state) {
  const std::string name = v1::SessionState_Name(state);
  return absl::AsciiStrToLower(absl::StripPrefix(name, "SESSION_STATE_"));
}

std::string SessionText(const v1::Session& session) {
  std::string text = absl::StrFormat(
      "%-32s %-10s frame %d/%d  %.4g s  %d broken  %d pieces", SessionId(session.name()),
      StateText(session.state()), session.head_frame(), session.goal_frame(),
      session.progress().time(), session.progress().broken_edges(), session.progress().fragments());
  if (session.viewer_count() > 0)
    absl::StrAppendFormat(&text, "  %d viewers", session.viewer_count());
  if (session.has_error()) absl::StrAppendFormat(&text, "  %s", session.error().message());
  return text;
}

std::string MessageJson(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  if (!google::protobuf::util::MessageToJsonString(message, &json, options).ok()) return "{}";
  return json;
}

}  // namespace cleave
