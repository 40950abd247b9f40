#include "client/cli/session_mesh.h"

#include <filesystem>

#include "client/cpp/mesh_transfer.h"
#include "core/base/status.h"
#include "proto/convert/mesh.h"

namespace cleave {

absl::Status KeepMeshes(Client& client, const v1::Scene& scene, const std::string& mesh_asset,
                        const RunFolder& folder) {
  if (!std::filesystem::exists(folder.mesh())) {
    CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, DownloadMesh(client, mesh_asset, nullptr));
    if (scene.mesh().has_unit_scale()) ScaleMesh(scene.mesh().unit_scale(), mesh);
    CLEAVE_RETURN_IF_ERROR(folder.WriteMesh(mesh));
  }
  if (scene.has_render_mesh() && !std::filesystem::exists(folder.render_mesh())) {
    CLEAVE_ASSIGN_OR_RETURN(RenderMesh mesh,
                            DownloadRenderMesh(client, scene.render_mesh().asset(), nullptr));
    if (scene.render_mesh().has_unit_scale()) ScaleMesh(scene.render_mesh().unit_scale(), mesh);
    CLEAVE_RETURN_IF_ERROR(folder.WriteRenderMesh(mesh));
  }
  return absl::OkStatus();
}

}  // namespace cleave
