#include "client/cli/render_mesh_input.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/number_check.h"
#include "client/cli/run_folder.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/surface/surface_file.h"
#include "core/base/status.h"
#include "core/scene/limits.h"
#include "core/scene/render_mesh_rules.h"
#include "proto/convert/mesh.h"

namespace cleave {
namespace {

absl::Status Named(const std::string& path, const absl::Status& status) {
  return absl::Status(status.code(), absl::StrCat(path, ": ", status.message()));
}

// What an earlier run or watch kept, if it kept one.
absl::StatusOr<std::optional<RenderMesh>> KeptRenderMesh(const std::string& path,
                                                         const TetMesh& mesh) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  auto kept = ParseRenderMesh(bytes);
  if (!kept.ok()) return Named(path, kept.status());
  Faults faults = CheckRenderMesh(*kept);
  if (faults.ok()) faults = CheckRenderMeshFits(*kept, mesh.rest_positions);
  if (!faults.ok()) return Named(path, faults.ToStatus());
  return *std::move(kept);
}

}  // namespace

void AddRenderMeshOptions(CLI::App& verb, RenderMeshOptions& options) {
  verb.add_option("--render-mesh", options.file,
                  "A fine triangle mesh (.obj, .ply, .stl, .glb) round the body at rest, which is "
                  "shown in place of its surface; it follows and breaks as the body does. Default: "
                  "that of the run's scene, if it has one")
      ->type_name("FILE");
  verb.add_option("--render-scale", options.scale,
                  "Metres for one unit of the file of --render-mesh; default: 1")
      ->check(NumberAbove(0, limits::kMaxUnitScale))
      ->type_name("METRES");
  verb.add_flag("--own-surface", options.own_surface,
                "The body's own surface, also where the run's scene has a render mesh");
}

void CheckRenderMeshOptions(const RenderMeshOptions& options, Faults& faults) {
  if (options.scale.has_value() && options.file.empty())
    faults.Error("--render-scale", "is of --render-mesh, which is missing");
  if (options.own_surface && !options.file.empty())
    faults.Error("--own-surface", "shows no render mesh, but --render-mesh names one");
}

absl::StatusOr<std::optional<RenderMesh>> ShownRenderMesh(const RenderMeshOptions& options,
                                                          const std::string& run,
                                                          const TetMesh& mesh) {
  if (options.own_surface) return std::nullopt;
  const std::string kept = RunFolder::Of(run).render_mesh();
  std::optional<RenderMesh> render;
  if (options.file.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(render, KeptRenderMesh(kept, mesh));
  } else {
    CLEAVE_ASSIGN_OR_RETURN(render, ReadRenderMeshFile(options.file));
    ScaleMesh(options.scale.value_or(1), *render);
    const Faults faults = CheckRenderMeshFits(*render, mesh.rest_positions);
    if (!faults.ok()) return Named(options.file, faults.ToStatus());
  }
  const int64_t open = render ? CountOpenEdges(render->triangles) : 0;
  if (open > 0)
    PrintNote(absl::StrCat(options.file.empty() ? kept : options.file, " ", OpenEdgesNote(open)));
  return render;
}

absl::StatusOr<RenderMesh> ReadRenderMeshFile(const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(SurfaceMesh surface, ReadSurfaceFile(path));
  RenderMesh render{std::move(surface.vertices), std::move(surface.triangles),
                    std::move(surface.uvs)};
  const Faults faults = CheckRenderMesh(render);
  if (!faults.ok()) return Named(path, faults.ToStatus());
  return render;
}

std::string OpenEdgesNote(int64_t open_edges) {
  return absl::StrCat("is not closed: ", open_edges,
                      " edges have no counterpart, and pieces will have holes there");
}

}  // namespace cleave
