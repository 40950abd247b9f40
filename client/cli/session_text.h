#ifndef CLEAVE_CLIENT_CLI_SESSION_TEXT_H_
#define CLEAVE_CLIENT_CLI_SESSION_TEXT_H_

#include <google/protobuf/message.h>

#include <string>

#include "absl/strings/string_view.h"
#include "cleave/v1/session.pb.h"

namespace cleave {

// "running", "idle", ...
std::string StateText(v1::SessionState state);

// One line: name, state, frames, time, broken edges, pieces.
std::string SessionText(const v1::Session& session);

// A message as one line of protobuf JSON with the names of the .proto files, defaults included.
std::string MessageJson(const google::protobuf::Message& message);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_SESSION_TEXT_H_
