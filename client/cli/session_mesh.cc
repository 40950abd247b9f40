#include "client/cli/session_mesh.h"

#include "client/cpp/mesh_transfer.h"
#include "core/base/status.h"
#include "proto/convert/mesh.h"

namespace cleave {

absl::StatusOr<TetMesh> SessionMesh(Client& client, const std::string& session,
                                    const std::string& asset) {
  CLEAVE_ASSIGN_OR_RETURN(const v1::Session answer, client.GetSession(session));
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, DownloadMesh(client, asset, nullptr));
  if (answer.scene().mesh().has_unit_scale()) ScaleMesh(answer.scene().mesh().unit_scale(), mesh);
  return mesh;
}

}  // namespace cleave
