#ifndef CLEAVE_CLIENT_CLI_SESSION_MESH_H_
#define CLEAVE_CLIENT_CLI_SESSION_MESH_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/cpp/client.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// The mesh (m) that a session's frames are of: its asset, fetched, in the scene's unit.
absl::StatusOr<TetMesh> SessionMesh(Client& client, const std::string& session,
                                    const std::string& asset);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_SESSION_MESH_H_
