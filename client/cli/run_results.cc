#include "client/cli/run_results.h"

#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/run_colliders.h"
#include "client/cli/run_folder.h"
#include "client/cli/scene_input.h"
#include "client/io/preview/scene_look.h"
#include "client/io/scene/scene_file.h"
#include "core/base/status.h"
#include "core/base/stopwatch.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/model/impurity_preview.h"
#include "core/scene/validate.h"
#include "proto/convert/scene.h"

namespace cleave {

namespace {

// The scene of a run, where its folder holds one.
absl::StatusOr<std::optional<Scene>> RunScene(const std::string& path) {
  const std::string scene_path = RunFolder::Of(path).scene();
  std::error_code error;
  if (!std::filesystem::exists(scene_path, error)) return std::nullopt;
  CLEAVE_ASSIGN_OR_RETURN(const SceneFile file, ReadSceneFile(scene_path));
  Faults faults;
  Scene scene = SceneFromMessage(file.scene, faults);
  if (!faults.ok()) return absl::InvalidArgumentError(file.Describe(faults.errors()));
  return scene;
}

}  // namespace

absl::StatusOr<std::vector<double>> RunPotencies(const std::string& path, const TetMesh& mesh) {
  CLEAVE_ASSIGN_OR_RETURN(const std::optional<Scene> scene, RunScene(path));
  if (!scene.has_value() || !scene->impurities.has_value()) return std::vector<double>();
  CLEAVE_RETURN_IF_ERROR(ValidateSceneWithMesh(*scene, mesh).ToStatus());
  CLEAVE_ASSIGN_OR_RETURN(ImpurityPreview preview, PreviewImpurities(*scene, mesh));
  return std::move(preview.potencies);
}

absl::Status ApplyRunLook(const std::string& path, const TetMesh& mesh, PreviewOptions& look) {
  CLEAVE_ASSIGN_OR_RETURN(const std::optional<Scene> found, RunScene(path));
  if (!found.has_value()) return absl::OkStatus();
  const Scene& scene = *found;
  const std::string title = look.title;
  ApplySceneLook(scene, mesh, look);
  // Reports may lie elsewhere, with a server of its own; then colliders stay where the scene puts
  // them.
  std::ifstream reports(RunFolder::Of(path).reports());
  std::stringstream lines;
  lines << reports.rdbuf();
  look.props = PropsOfRun(scene, lines.str());
  if (!title.empty()) look.title = title;
  return absl::OkStatus();
}

absl::StatusOr<RecordedRun> OpenRecordedRun(const std::string& path, const std::string& mesh_path,
                                            double unit_scale) {
  std::error_code error;
  const bool folder = std::filesystem::is_directory(path, error);
  const std::string frames = folder ? RunFolder(path).frames() : path;
  if (!std::filesystem::exists(frames, error))
    return absl::NotFoundError(absl::StrCat(frames, ": there is no such recording"));
  std::string mesh_file = mesh_path;
  if (mesh_file.empty()) mesh_file = RunFolder::Of(path).mesh();
  if (mesh_path.empty() && !std::filesystem::exists(mesh_file, error))
    return absl::NotFoundError(absl::StrCat(mesh_file, ": is not there; name the mesh of ", frames,
                                            " with --mesh (a scene file will do)"));
  RecordedRun run;
  CLEAVE_ASSIGN_OR_RETURN(run.mesh, ReadAnyMesh(mesh_file, unit_scale));
  CLEAVE_RETURN_IF_ERROR(CheckAndOrientMesh(run.mesh).ToStatus());
  const auto edges = BuildIncidence(run.mesh).edges;
  CLEAVE_ASSIGN_OR_RETURN(run.recording,
                          OpenRecording(frames, {run.mesh.rest_positions, edges, run.mesh.tets}));
  if (run.recording.frames.count == 0)
    return absl::FailedPreconditionError(absl::StrCat(frames, ": holds no frames yet"));
  if (!run.recording.ended)
    PrintNote(absl::StrCat(frames, ": was cut after frame ", run.recording.rows.back().frame,
                           ", or is still written"));
  return run;
}

absl::StatusOr<FrameSource> SelectFrames(const Recording& recording, int64_t first, int64_t last,
                                         int64_t stride) {
  auto positions = std::make_shared<std::vector<int64_t>>();
  for (size_t i = 0; i < recording.rows.size(); ++i) {
    const int64_t frame = recording.rows[i].frame;
    if (frame >= first && frame <= last && (frame - first) % stride == 0)
      positions->push_back(static_cast<int64_t>(i));
  }
  if (positions->empty())
    return absl::InvalidArgumentError(absl::StrCat(
        "no frame is left from ", first,
        last == std::numeric_limits<int64_t>::max() ? "" : absl::StrCat(" to ", last),
        "; the recording has ", recording.rows.front().frame, " to ", recording.rows.back().frame));
  FrameSource selected;
  selected.count = static_cast<int64_t>(positions->size());
  selected.surface_only = recording.frames.surface_only;
  selected.pass_by = [positions, read = recording.frames.read](
                         int64_t position, const FrameSource::Visit& visit) -> absl::Status {
    const auto at = static_cast<size_t>(position);
    for (int64_t i = at == 0 ? 0 : (*positions)[at - 1] + 1; i < (*positions)[at]; ++i) {
      CLEAVE_ASSIGN_OR_RETURN(const Frame frame, read(i));
      CLEAVE_RETURN_IF_ERROR(visit(frame));
    }
    return absl::OkStatus();
  };
  selected.read = [positions, read = recording.frames.read](int64_t position) {
    return read((*positions)[static_cast<size_t>(position)]);
  };
  return selected;
}

Progress ShowingProgress(std::string what, Interrupt& interrupt) {
  constexpr double kSeconds = 2;
  const auto watch = std::make_shared<Stopwatch>();
  const auto shown = std::make_shared<double>(0);
  return [what = std::move(what), &interrupt, watch, shown](int64_t done, int64_t total) {
    if (watch->Seconds() - *shown > kSeconds) {
      *shown = watch->Seconds();
      PrintNote(absl::StrCat(what, ": ", done, " of ", total));
    }
    return !interrupt.stop().requested();
  };
}

}  // namespace cleave
