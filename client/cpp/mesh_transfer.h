#ifndef CLEAVE_CLIENT_CPP_MESH_TRANSFER_H_
#define CLEAVE_CLIENT_CPP_MESH_TRANSFER_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/cpp/client.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Called as bytes are sent or received, from the calling thread.
using TransferProgress = std::function<void(int64_t bytes_done, int64_t bytes_total)>;

// An uploaded mesh.
struct UploadedMesh {
  std::string asset;                  // SHA-256 in hex: goes into MeshSource.asset
  std::vector<std::string> warnings;  // what the server's mesh check accepted but frowned at
  int64_t bytes_sent = 0;             // 0 when the server had it
};

// Sends a mesh unless the server has it, in checked 256 KiB chunks. A cut connection is resumed
// where the server's durable bytes end, also by a later process. Errors: InvalidArgument with the
// server's findings about the mesh, Unavailable when repeating did not help, Cancelled on stop.
absl::StatusOr<UploadedMesh> UploadMesh(Client& client, const TetMesh& mesh,
                                        const TransferProgress& progress);

// Fetches a mesh by its asset name (SHA-256 in hex) and checks it against that name. Coordinates
// are as uploaded: unit_scale is not applied. Errors: NotFound, DataLoss, Unavailable, Cancelled.
absl::StatusOr<TetMesh> DownloadMesh(Client& client, const std::string& asset,
                                     const TransferProgress& progress);

// The same for a render mesh, whose asset goes into RenderMeshSource.asset.
absl::StatusOr<UploadedMesh> UploadRenderMesh(Client& client, const RenderMesh& mesh,
                                              const TransferProgress& progress);
absl::StatusOr<RenderMesh> DownloadRenderMesh(Client& client, const std::string& asset,
                                              const TransferProgress& progress);

// Lower-case hexadecimal digits of bytes.
std::string ToHex(absl::string_view bytes);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_MESH_TRANSFER_H_
