#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/console.h"
#include "client/cli/heartbeat.h"
#include "client/cli/mesh_text.h"
#include "client/cli/named_value.h"
#include "client/cli/number_check.h"
#include "client/cli/program.h"
#include "client/cli/progress.h"
#include "client/io/export/vtu.h"
#include "client/io/series/write_aside.h"
#include "client/io/surface/surface_file.h"
#include "core/base/status.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/quality.h"
#include "core/mesh/surface_mesh.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

constexpr double kLeastShare = 0.9;

struct Options {
  std::string surface;
  double unit_scale = 1;
  MeshResolution resolution;
  std::string out;
  bool json = false;
};

// Before the work, which may take minutes.
absl::Status PrepareOut(const std::string& out) {
  if (out.empty()) return absl::OkStatus();
  if (!absl::EndsWithIgnoreCase(out, ".vtu"))
    return absl::InvalidArgumentError(
        absl::StrCat("--out: ", out, " does not end in .vtu, which is what it would hold"));
  return MakeDirectories(std::filesystem::path(out).parent_path().string());
}

absl::Status MakeMesh(const Options& options) {
  CLEAVE_RETURN_IF_ERROR(PrepareOut(options.out));
  CLEAVE_ASSIGN_OR_RETURN(SurfaceMesh surface, ReadSurfaceFile(options.surface));
  for (Vec3& vertex : surface.vertices) {
    for (double& coordinate : vertex) coordinate *= options.unit_scale;
  }
  PrintNote(absl::StrCat("filling ", options.surface, " with tets"));
  std::optional<Heartbeat> heartbeat;
  heartbeat.emplace(std::chrono::seconds(5), [&](double seconds) {
    PrintNote(absl::StrCat("filling ", options.surface, ": at it for ", FormatSeconds(seconds)));
  });
  auto body = MeshSurface(surface.vertices, surface.triangles, options.resolution);
  heartbeat.reset();
  if (!body.ok()) {
    return absl::Status(body.status().code(),
                        absl::StrCat(options.surface, ": ", body.status().message()));
  }
  const Faults faults = CheckAndOrientMesh(body->mesh);
  PrintWarnings(faults.warnings());
  if (!faults.ok()) return faults.ToStatus();
  if (!options.out.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(const std::string bytes,
                            EncodeVtu(TetGrid(body->mesh), "a body of tets"));
    CLEAVE_RETURN_IF_ERROR(WriteAside(options.out, bytes));
    PrintNote(absl::StrCat("wrote ", options.out));
  }
  const MeshReport report = ReportMesh(body->mesh, BuildIncidence(body->mesh));
  if (report.volume < kLeastShare * body->surface_volume) {
    PrintNote(
        absl::StrFormat("the body has %.0f %% of the surface's volume: parts are thinner than "
                        "cells, smaller ones keep them",
                        100 * report.volume / body->surface_volume));
  }
  if (options.json) {
    PrintResult(MeshReportJson(report, faults.warnings())
                    .Add("surface_volume", body->surface_volume)
                    .Add("open_edges", body->open_edges)
                    .Add("dropped_parts", body->dropped_parts)
                    .Str());
    return absl::OkStatus();
  }
  PrintResult(MeshReportText(report));
  PrintResult(absl::StrFormat(
      "of surface   %d triangles around %.6g m^3, %d open edges, %d parts "
      "dropped that the cells tore off",
      surface.triangles.size(), body->surface_volume, body->open_edges, body->dropped_parts));
  return absl::OkStatus();
}

}  // namespace

void AddMesh(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand(
      "mesh", "Make a body of tets of a surface, as modelling programs write them");
  auto options = std::make_shared<Options>();
  verb->add_option("surface", options->surface, "Surface file (.obj, .ply, .stl, .glb)")
      ->required()
      ->type_name("SURFACE");
  verb->add_option("--cell", options->resolution.cell_size, "Wanted edge length")
      ->required()
      ->check(NumberAbove(0, limits::kMaxUnitScale))
      ->type_name("METRES");
  verb->add_option("-o,--out", options->out, "Write the mesh here, as VTU")->type_name("FILE.vtu");
  verb->add_option("--unit-scale", options->unit_scale, "Metres for one unit of the file")
      ->check(NumberAbove(0, limits::kMaxUnitScale))
      ->capture_default_str()
      ->type_name("METRES");
  const std::map<std::string, MeshLayout> layouts = {{"unstructured", MeshLayout::kUnstructured},
                                                     {"lattice", MeshLayout::kJitteredLattice}};
  verb->add_option("--layout", options->resolution.layout, "How nodes lie inside")
      ->transform(NamedValue(layouts))
      ->default_str("unstructured");
  verb->add_option("--seed", options->resolution.seed, "Of the random places of nodes")
      ->capture_default_str();
  verb->add_flag("--json", options->json, "As a line of JSON");
  verb->footer(
      "Inside is what the surface goes round, holes are closed, parts that overlap are one.\n"
      "Run the body with the surface as its render mesh to break what the artist made.\n\n"
      "Examples:\n"
      "  cleave mesh koala.obj --cell 0.2 -o koala.vtu\n"
      "  cleave export out/koala --format obj --render-mesh koala.obj\n");
  verb->callback(
      [options, &program] { program.action = [options](Program&) { return MakeMesh(*options); }; });
}

}  // namespace cleave
