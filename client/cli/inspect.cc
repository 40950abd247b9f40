#include <cmath>
#include <memory>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/console.h"
#include "client/cli/json_line.h"
#include "client/cli/program.h"
#include "client/cli/scene_input.h"
#include "core/base/status.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/quality.h"

namespace cleave {
namespace {

constexpr double kDegrees = 180 / M_PI;

struct Options {
  std::string mesh;
  double unit_scale = 1;
  bool json = false;
};

std::string Vector(const Vec3& v) { return absl::StrFormat("%.6g %.6g %.6g", v[0], v[1], v[2]); }
std::string VectorJson(const Vec3& v) {
  return JsonList({JsonNumber(v[0]), JsonNumber(v[1]), JsonNumber(v[2])});
}
std::string RangeJson(const Range& range) {
  return JsonLine().Add("min", range.min).Add("mean", range.mean).Add("max", range.max).Str();
}

void PrintText(const MeshReport& report) {
  PrintResult(absl::StrCat("nodes        ", report.node_count, " (", report.unreferenced_node_count,
                           " in no tet)"));
  PrintResult(absl::StrCat("tets         ", report.tet_count));
  PrintResult(absl::StrCat("edges        ", report.edge_count));
  PrintResult(absl::StrCat("surface      ", report.boundary_face_count, " triangles, ",
                           absl::StrFormat("%.6g m^2", report.surface_area)));
  PrintResult(absl::StrCat("components   ", report.component_count));
  PrintResult(absl::StrFormat("volume       %.6g m^3", report.volume));
  PrintResult(absl::StrCat("from         ", Vector(report.min_corner), " m"));
  PrintResult(absl::StrCat("to           ", Vector(report.max_corner), " m"));
  PrintResult(absl::StrFormat("edge length  %.4g to %.4g m, mean %.4g m", report.edge_length.min,
                              report.edge_length.max, report.edge_length.mean));
  PrintResult(absl::StrFormat("aspect       %.3g to %.3g, mean %.3g (1: regular)",
                              report.aspect.min, report.aspect.max, report.aspect.mean));
  PrintResult(absl::StrFormat("angles       %.1f to %.1f degrees between faces (regular: 70.5)",
                              report.min_dihedral * kDegrees, report.max_dihedral * kDegrees));
  for (const RegionReport& region : report.regions)
    PrintResult(absl::StrCat("region       ", region.id,
                             region.name.empty() ? "" : absl::StrCat(" \"", region.name, "\""),
                             ": ", region.tet_count, " tets, ",
                             absl::StrFormat("%.6g m^3", region.volume)));
  PrintResult(absl::StrCat(
      "worst tets   ",
      absl::StrJoin(report.worst, ", ", [](std::string* out, const WorstTet& worst) {
        absl::StrAppendFormat(out, "%d (%.1f deg)", worst.tet, worst.min_dihedral * kDegrees);
      })));
}

void PrintJson(const MeshReport& report, const Faults& faults) {
  std::vector<std::string> regions, worst, warnings;
  for (const RegionReport& region : report.regions)
    regions.push_back(JsonLine()
                          .Add("id", int64_t{region.id})
                          .Add("name", region.name)
                          .Add("tets", region.tet_count)
                          .Add("volume", region.volume)
                          .Str());
  for (const WorstTet& tet : report.worst)
    worst.push_back(JsonLine()
                        .Add("tet", tet.tet)
                        .Add("min_dihedral_degrees", tet.min_dihedral * kDegrees)
                        .Add("aspect", tet.aspect)
                        .Str());
  for (const Fault& warning : faults.warnings())
    warnings.push_back(
        JsonLine().Add("field", warning.field).Add("description", warning.description).Str());
  PrintResult(JsonLine()
                  .Add("nodes", report.node_count)
                  .Add("tets", report.tet_count)
                  .Add("edges", report.edge_count)
                  .Add("boundary_faces", report.boundary_face_count)
                  .Add("components", report.component_count)
                  .Add("unreferenced_nodes", report.unreferenced_node_count)
                  .Add("volume", report.volume)
                  .Add("surface_area", report.surface_area)
                  .AddJson("min_corner", VectorJson(report.min_corner))
                  .AddJson("max_corner", VectorJson(report.max_corner))
                  .AddJson("edge_length", RangeJson(report.edge_length))
                  .AddJson("aspect", RangeJson(report.aspect))
                  .Add("min_dihedral_degrees", report.min_dihedral * kDegrees)
                  .Add("max_dihedral_degrees", report.max_dihedral * kDegrees)
                  .AddJson("regions", JsonList(regions))
                  .AddJson("worst_tets", JsonList(worst))
                  .AddJson("warnings", JsonList(warnings))
                  .Str());
}

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
  if (options.json)
    PrintJson(report, faults);
  else
    PrintText(report);
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
      ->check(CLI::PositiveNumber)
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
