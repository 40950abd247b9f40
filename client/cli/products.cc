#include "client/cli/products.h"

#include <filesystem>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/render_mesh_input.h"
#include "client/cli/run_plot.h"
#include "client/cli/run_results.h"
#include "client/io/export/export_series.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/preview/preview.h"
#include "client/io/scene/scene_file.h"
#include "client/io/series/write_aside.h"
#include "core/base/status.h"
#include "proto/convert/scene.h"

namespace cleave {

std::string ProductOptions::Words() const {
  return absl::StrCat(vtu ? " --vtu" : "", ply ? " --ply" : "", preview ? " --preview" : "",
                      plot ? " --plot" : "");
}

void AddProductOptions(CLI::App& verb, ProductOptions& options) {
  verb.add_flag("--vtu", options.vtu, "Also write DIR/vtu, a series for ParaView");
  verb.add_flag("--ply", options.ply, "Also write DIR/ply, a surface a frame");
  verb.add_flag("--preview", options.preview,
                "Also draw DIR/contact_sheet.png and DIR/preview.webp");
  verb.add_flag("--plot", options.plot,
                "Also draw DIR/plot.svg: force and broken edges over time (private server only)");
}

absl::Status MakePlot(const RunFolder& folder, const std::string& reports_path,
                      const std::string& target) {
  std::error_code error;
  if (!std::filesystem::exists(reports_path, error))
    return absl::NotFoundError(absl::StrCat(
        reports_path, ": is not there; the forces of a run are in the reports of the server that ",
        "made it, sessions/NAME/reports.jsonl in its data folder"));
  CLEAVE_ASSIGN_OR_RETURN(const std::string reports, ReadFileBytes(reports_path));
  CLEAVE_ASSIGN_OR_RETURN(const SceneFile file, ReadSceneFile(folder.scene()));
  Faults faults;
  const Scene scene = SceneFromMessage(file.scene, faults);
  if (!faults.ok()) return absl::InvalidArgumentError(file.Describe(faults.errors()));
  CLEAVE_ASSIGN_OR_RETURN(const std::vector<PlotSample> samples, SamplesOfReports(reports, scene));
  PlotOptions options;
  options.title = scene.name;
  return WritePlot(target, samples, options);
}

absl::StatusOr<std::vector<std::string>> MakeProducts(const RunFolder& folder,
                                                      const ProductOptions& options,
                                                      Interrupt& interrupt) {
  std::vector<std::string> paths;
  if (!options.any()) return paths;
  if (options.plot) {
    paths.push_back(folder.path() + "/plot.svg");
    CLEAVE_RETURN_IF_ERROR(MakePlot(folder, folder.reports(), paths.back()));
  }
  if (!options.vtu && !options.ply && !options.preview) return paths;
  CLEAVE_ASSIGN_OR_RETURN(const RecordedRun run, OpenRecordedRun(folder.path(), "", 1));
  const FrameSource& frames = run.recording.frames;
  std::vector<double> potencies;
  if (options.vtu || options.ply) {
    CLEAVE_ASSIGN_OR_RETURN(potencies, RunPotencies(folder.path(), run.mesh));
  }
  CLEAVE_ASSIGN_OR_RETURN(const std::optional<RenderMesh> render_mesh,
                          ShownRenderMesh({}, folder.path(), run.mesh));
  const RenderMesh* shown = render_mesh ? &*render_mesh : nullptr;
  if (options.vtu) {
    CLEAVE_ASSIGN_OR_RETURN(const ExportResult result,
                            WriteVtuSeries(run.mesh, frames, VtuContent::kSurface,
                                           {folder.path() + "/vtu", "cleave", potencies, shown},
                                           ShowingProgress("writing VTU files", interrupt)));
    paths.push_back(result.collection);
  }
  if (options.ply) {
    paths.push_back(folder.path() + "/ply");
    CLEAVE_RETURN_IF_ERROR(WritePlySeries(run.mesh, frames,
                                          {paths.back(), "cleave", potencies, shown},
                                          ShowingProgress("writing PLY files", interrupt))
                               .status());
  }
  if (options.preview) {
    PreviewOptions look;
    CLEAVE_RETURN_IF_ERROR(ApplyRunLook(folder.path(), run.mesh, look));
    look.render_mesh = shown;
    look.width = 480;
    CLEAVE_ASSIGN_OR_RETURN(
        const Image sheet,
        RenderContactSheet(run.mesh, frames, SheetOptions(), look,
                           ShowingProgress("drawing the contact sheet", interrupt)));
    paths.push_back(folder.path() + "/contact_sheet.png");
    CLEAVE_RETURN_IF_ERROR(WritePng(paths.back(), sheet));
    look.width = 640;
    CLEAVE_ASSIGN_OR_RETURN(const std::string animation,
                            RenderAnimation(run.mesh, frames, AnimationOptions(), look,
                                            ShowingProgress("drawing the animation", interrupt)));
    paths.push_back(folder.path() + "/preview.webp");
    CLEAVE_RETURN_IF_ERROR(WriteAside(paths.back(), animation));
  }
  return paths;
}

}  // namespace cleave
