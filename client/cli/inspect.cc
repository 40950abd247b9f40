#include <memory>

#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/mesh_text.h"
#include "client/cli/number_check.h"
#include "client/cli/program.h"
#include "client/cli/scene_input.h"
#include "core/base/status.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/quality.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

struct Options {
  std::string mesh;
  double unit_scale = 1;
  bool json = false;
};

absl::Status Inspect(const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, ReadAnyMesh(options.mesh, options.unit_scale));
  const Faults faults = CheckAndOrientMesh(mesh);
  if (!options.json || !faults.ok()) PrintWarnings(faults.warnings());
  if (!faults.ok()) {
    PrintNote(absl::StrCat(options.mesh, ": ", mesh.node_count(), " nodes, ", mesh.tet_count(),
                           " tets, ", faults.error_count(), " faults:"));
    return faults.ToStatus();
  }
  const MeshReport report = ReportMesh(mesh, BuildIncidence(mesh));
  PrintResult(options.json ? MeshReportJson(report, faults.warnings()).Str()
                           : MeshReportText(report));
  return absl::OkStatus();
}

}  // namespace

void AddInspect(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand(
      "inspect", "Show a mesh: counts, quality, components, regions, and faults with ids");
  auto options = std::make_shared<Options>();
  verb->add_option("mesh", options->mesh,
                   "Mesh file (Gmsh, VTU, VTK, TetGen, Medit, Vega), or a scene file for its mesh")
      ->required()
      ->type_name("MESH");
  verb->add_option("--unit-scale", options->unit_scale, "Metres for one unit of a mesh file")
      ->check(NumberAbove(0, limits::kMaxUnitScale))
      ->capture_default_str()
      ->type_name("METRES");
  verb->add_flag("--json", options->json, "As a line of JSON");
  verb->footer(
      "Exit code 3 and a line a fault when the mesh cannot be simulated.\n\n"
      "Examples:\n"
      "  cleave inspect rod.msh --unit-scale 0.001\n"
      "  cleave inspect bar.scene.json          the scene's mesh, also a procedural one\n");
  verb->callback(
      [options, &program] { program.action = [options](Program&) { return Inspect(*options); }; });
}

}  // namespace cleave
