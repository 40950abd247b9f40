#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/console.h"
#include "client/cli/number_check.h"
#include "client/cli/products.h"
#include "client/cli/program.h"
#include "client/cli/render_mesh_input.h"
#include "client/cli/run_results.h"
#include "client/io/bake/bake.h"
#include "client/io/export/export_series.h"
#include "client/io/series/write_aside.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

struct Options {
  std::string run;
  std::string mesh;
  std::string reports;
  double unit_scale = 1;
  std::string format = "vtu";
  std::string to;
  std::string name = "cleave";
  int64_t first = 0;
  int64_t last = std::numeric_limits<int64_t>::max();
  int64_t stride = 1;
  RenderMeshOptions render_mesh;
  std::optional<double> rate;
  bool velocities = false;
  std::vector<std::string> of_frames;  // those given that no plot has a use for
};

const std::map<std::string, BakeFormat>& BakeFormats() {
  static const auto* formats = new std::map<std::string, BakeFormat>{{"bake-pc2", BakeFormat::kPc2},
                                                                     {"bake-mdd", BakeFormat::kMdd},
                                                                     {"glb", BakeFormat::kGlb},
                                                                     {"usda", BakeFormat::kUsda}};
  return *formats;
}

const std::set<std::string>& SurfaceFormats() {
  static const auto* formats =
      new std::set<std::string>{"vtu", "ply", "obj", "bake-pc2", "bake-mdd", "glb", "usda"};
  return *formats;
}

// exports/vtu beside the recording, unless said otherwise.
std::string TargetFolder(const Options& options) {
  if (!options.to.empty()) return options.to;
  std::filesystem::path beside = options.run;
  std::error_code error;
  if (!std::filesystem::is_directory(beside, error)) beside = beside.parent_path();
  return (beside / options.format).string();
}

absl::Status ExportPlot(const Options& options) {
  const RunFolder folder(options.run);
  const std::string target =
      absl::StrCat(options.to.empty() ? options.run : options.to, "/plot.svg");
  if (!options.to.empty()) CLEAVE_RETURN_IF_ERROR(MakeDirectories(options.to));
  CLEAVE_RETURN_IF_ERROR(
      MakePlot(folder, options.reports.empty() ? folder.reports() : options.reports, target));
  PrintResult(target);
  return absl::OkStatus();
}

// Options that the format has no use for, all at once.
absl::Status CheckFormat(const Options& options) {
  Faults faults;
  const auto goes_with = [&](bool given, const char* option, std::set<std::string> formats) {
    if (given && formats.count(options.format) == 0)
      faults.Error(option, absl::StrCat("goes with --format ", absl::StrJoin(formats, ", "),
                                        ", not ", options.format));
  };
  goes_with(!options.render_mesh.file.empty(), "--render-mesh", SurfaceFormats());
  goes_with(options.rate.has_value(), "--rate", {"bake-mdd", "glb", "usda"});
  goes_with(options.velocities, "--velocities", {"bake-pc2", "bake-mdd", "glb"});
  goes_with(!options.reports.empty(), "--reports", {"plot"});
  if (options.format == "plot") {
    for (const std::string& option : options.of_frames)
      faults.Error(option, "goes with frames, not with plot, which is of the whole run");
  }
  if (options.name.empty() || options.name.find('/') != std::string::npos)
    faults.Error("--name",
                 absl::StrCat("\"", options.name, "\" is no name of a file: --to says where"));
  if (std::any_of(options.name.begin(), options.name.end(), absl::ascii_iscntrl))
    faults.Error("--name",
                 absl::StrCat("\"", absl::CEscape(options.name), "\" holds a control character"));
  CheckRenderMeshOptions(options.render_mesh, faults);
  return faults.ToStatus();
}

void NoteGaps(int64_t gaps) {
  if (gaps == 0) return;
  PrintNote(absl::StrCat("the render mesh does not follow the body's shape at ", gaps,
                         " faces; where these break, pieces are closed by flat caps"));
}

absl::Status ExportBake(Program& program, const Options& options, const RecordedRun& run,
                        const FrameSource& frames, const RenderMesh* render_mesh) {
  BakeOptions target;
  target.folder = TargetFolder(options);
  target.name = options.name;
  target.format = BakeFormats().at(options.format);
  target.playback_rate = options.rate;
  target.velocities = options.velocities;
  target.render_mesh = render_mesh;
  PreviewOptions look;
  CLEAVE_RETURN_IF_ERROR(ApplyRunLook(options.run, run.mesh, look));
  target.up = look.camera.up.value_or(Vec3{0, 0, 1});
  CLEAVE_ASSIGN_OR_RETURN(
      const BakeResult result,
      WriteBake(run.mesh, frames, target, ShowingProgress("baking frames", program.interrupt)));
  PrintResult(result.path);
  for (const std::string& path : result.also) PrintResult(path);
  PrintNote(absl::StrCat(result.written, " frames written, ", result.kept, " were there already"));
  NoteGaps(result.gaps);
  return absl::OkStatus();
}

absl::Status Export(Program& program, const Options& options) {
  CLEAVE_RETURN_IF_ERROR(CheckFormat(options));
  if (options.format == "plot") return ExportPlot(options);
  CLEAVE_ASSIGN_OR_RETURN(const RecordedRun run,
                          OpenRecordedRun(options.run, options.mesh, options.unit_scale));
  CLEAVE_ASSIGN_OR_RETURN(const FrameSource frames,
                          SelectFrames(run.recording, options.first, options.last, options.stride));
  std::optional<RenderMesh> render_mesh;
  if (SurfaceFormats().count(options.format) > 0) {
    CLEAVE_ASSIGN_OR_RETURN(render_mesh,
                            ShownRenderMesh(options.render_mesh, options.run, run.mesh));
  }
  const RenderMesh* shown = render_mesh ? &*render_mesh : nullptr;
  if (BakeFormats().count(options.format) > 0)
    return ExportBake(program, options, run, frames, shown);
  ExportOptions target;
  target.folder = TargetFolder(options);
  target.name = options.name;
  if (options.format != "obj") {
    CLEAVE_ASSIGN_OR_RETURN(target.node_potencies, RunPotencies(options.run, run.mesh));
  }
  target.render_mesh = shown;
  const Progress progress = ShowingProgress("exporting frames", program.interrupt);
  const auto result = options.format == "ply" ? WritePlySeries(run.mesh, frames, target, progress)
                      : options.format == "obj"
                          ? WriteObjSeries(run.mesh, frames, target, progress)
                          : WriteVtuSeries(run.mesh, frames,
                                           options.format == "vtu-volume" ? VtuContent::kVolume
                                                                          : VtuContent::kSurface,
                                           target, progress);
  if (!result.ok()) return result.status();
  PrintResult(result->collection.empty() ? target.folder : result->collection);
  PrintNote(absl::StrCat(result->written, " files written, ", result->kept, " were there already"));
  NoteGaps(result->gaps);
  return absl::OkStatus();
}

}  // namespace

void AddExport(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand("export", "Write recorded frames for other tools, or a plot");
  auto options = std::make_shared<Options>();
  verb->add_option("run", options->run, "Folder of a run, or a .clv file")
      ->required()
      ->type_name("RUN");
  verb->add_option(
          "--format", options->format,
          "vtu: surfaces with cracks, for ParaView; vtu-volume: all tets; ply, obj: surfaces; "
          "bake-pc2, bake-mdd: one OBJ of the pieces and a cache of its points, for Blender; "
          "glb: the same as animated glTF; usda: as USD text (not yet played by a USD "
          "program); plot: force and broken edges over time as SVG")
      ->check(CLI::IsMember(
          {"vtu", "vtu-volume", "ply", "obj", "bake-pc2", "bake-mdd", "glb", "usda", "plot"}))
      ->capture_default_str();
  verb->add_option("--to", options->to, "Folder for the files; default: RUN/FORMAT")
      ->type_name("DIR");
  verb->add_option("--name", options->name, "What file names begin with")->capture_default_str();
  verb->add_option("--mesh", options->mesh,
                   "Mesh of the recording: a mesh or scene file; default: mesh.pb beside it")
      ->type_name("MESH");
  verb->add_option("--unit-scale", options->unit_scale, "Metres for one unit of a mesh file")
      ->check(NumberAbove(0, limits::kMaxUnitScale))
      ->capture_default_str()
      ->type_name("METRES");
  AddRenderMeshOptions(*verb, options->render_mesh);
  verb->add_option("--reports", options->reports,
                   "For plot: the report lines; default: reports.jsonl in RUN")
      ->type_name("FILE");
  verb->add_option("--first", options->first, "First frame")
      ->check(CountWithin(0, int64_t{1} << 40));
  verb->add_option("--last", options->last, "Last frame")->check(CountWithin(0, int64_t{1} << 40));
  verb->add_option("--stride", options->stride, "Every N-th frame")
      ->check(CountWithin(1, int64_t{1} << 40))
      ->type_name("N");
  verb->add_option("--rate", options->rate,
                   "For bake-mdd, glb and usda: frames a second when played; default: as simulated")
      ->check(NumberWithin(1e-3, 1e5))
      ->type_name("FPS");
  verb->add_flag("--velocities", options->velocities,
                 "For bake-pc2, bake-mdd and glb: velocities of the points as well");
  verb->footer(
      "Prints the .pvd (open it in ParaView), the folder, or the baked files. Files that are "
      "there\n"
      "already from the same frames are kept, so an export that was cut goes on.\n\n"
      "Examples:\n"
      "  cleave export out/bar\n"
      "  cleave export out/bar --format ply --first 10 --last 10 --to now\n"
      "  cleave export out/bar --format bake-pc2\n"
      "  cleave export out/bar --format glb --rate 24\n");
  verb->callback([options, verb, &program] {
    for (const char* option : {"--first", "--last", "--stride", "--name", "--mesh", "--unit-scale"})
      if (verb->count(option) > 0) options->of_frames.emplace_back(option);
    program.action = [options](Program& shared) { return Export(shared, *options); };
  });
}

}  // namespace cleave
