#ifndef CLEAVE_CLIENT_CLI_RENDER_MESH_INPUT_H_
#define CLEAVE_CLIENT_CLI_RENDER_MESH_INPUT_H_

#include <CLI/App.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "core/base/faults.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// What the verbs that show a run take as its surface.
struct RenderMeshOptions {
  std::string file;
  std::optional<double> scale;
  bool own_surface = false;
};

// --render-mesh, --render-scale and --own-surface.
void AddRenderMeshOptions(CLI::App& verb, RenderMeshOptions& options);
void CheckRenderMeshOptions(const RenderMeshOptions& options, Faults& faults);

// The render mesh (m) to show: that of the options, or what the run's folder (or the .clv's) holds
// of its scene, or none. Says where it is not closed. Errors: InvalidArgument, with
// the path, for what CheckRenderMesh and CheckRenderMeshFits refuse; what reading gives.
absl::StatusOr<std::optional<RenderMesh>> ShownRenderMesh(const RenderMeshOptions& options,
                                                          const std::string& run,
                                                          const TetMesh& mesh);

// A render mesh from a file of triangles, in its unit. Errors: InvalidArgument, with the path, for
// what CheckRenderMesh refuses; what reading the file gives.
absl::StatusOr<RenderMesh> ReadRenderMeshFile(const std::string& path);

// What edges without counterpart mean.
std::string OpenEdgesNote(int64_t open_edges);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_RENDER_MESH_INPUT_H_
