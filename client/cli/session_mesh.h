#ifndef CLEAVE_CLIENT_CLI_SESSION_MESH_H_
#define CLEAVE_CLIENT_CLI_SESSION_MESH_H_

#include <string>

#include "absl/status/status.h"
#include "client/cli/run_folder.h"
#include "client/cpp/client.h"

namespace cleave {

// Fetches what the folder of a session's recording lacks: the mesh that its frames are of and,
// where the session's scene has one, its render mesh; both in metres.
absl::Status KeepMeshes(Client& client, const v1::Scene& scene, const std::string& mesh_asset,
                        const RunFolder& folder);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_SESSION_MESH_H_
