#ifndef CLEAVE_CLIENT_CLI_SESSION_START_H_
#define CLEAVE_CLIENT_CLI_SESSION_START_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/cli/scene_input.h"
#include "client/cpp/client.h"

namespace cleave {

// The scene as a server takes it: a mesh file and a render mesh's are uploaded and named as assets.
// Shows the transfer on stderr where it takes long.
absl::StatusOr<v1::Scene> SceneForServer(Client& client, const SceneInput& input, bool quiet);

// "notched-rod-3f2a" for scenes/Notched_Rod.scene.json: a valid session id that is free.
std::string NewSessionId(absl::string_view scene_path);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_SESSION_START_H_
