#ifndef CLEAVE_CLIENT_CLI_VALIDATE_ONLY_H_
#define CLEAVE_CLIENT_CLI_VALIDATE_ONLY_H_

#include "absl/status/statusor.h"
#include "client/cli/scene_input.h"
#include "client/cpp/client.h"

namespace cleave {

// Lets the server check a scene and plan its run, creating nothing but the uploaded mesh. Faults
// name the lines of the scene file.
absl::StatusOr<v1::CreateSessionResponse> ValidateOnServer(Client& client, const SceneInput& input,
                                                           bool quiet);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_VALIDATE_ONLY_H_
