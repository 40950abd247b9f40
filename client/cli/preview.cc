#include "client/io/preview/preview.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/console.h"
#include "client/cli/named_value.h"
#include "client/cli/number_check.h"
#include "client/cli/program.h"
#include "client/cli/render_mesh_input.h"
#include "client/cli/run_results.h"
#include "client/io/series/write_aside.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

struct Options {
  std::string run;
  std::string mesh;
  std::string to;
  double unit_scale = 1;
  std::optional<std::string> still;
  bool sheet = false;
  bool animation = false;
  std::optional<std::string> turntable;
  int64_t stride = 1;
  PreviewOptions look;
  SheetOptions sheet_look;
  AnimationOptions animation_look;
  std::optional<double> azimuth, elevation;
  RenderMeshOptions render_mesh;
};

// Pictures of one recording, each written when it is drawn.
class Pictures {
 public:
  Pictures(Program& program, const Options& options, const RecordedRun& run)
      : program_(program), options_(options), run_(run), look_(options.look) {}

  absl::Status Draw() {
    CLEAVE_RETURN_IF_ERROR(ApplyRunLook(options_.run, run_.mesh, look_));
    if (look_.color_by == ColorBy::kImpurity) {
      CLEAVE_ASSIGN_OR_RETURN(look_.node_potencies, RunPotencies(options_.run, run_.mesh));
      if (look_.node_potencies.empty()) {
        return absl::FailedPreconditionError(absl::StrCat(
            "--color impurity: there is no scene with impurities beside ", options_.run));
      }
    }
    Faults faults;
    CheckRenderMeshOptions(options_.render_mesh, faults);
    CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
    CLEAVE_ASSIGN_OR_RETURN(render_mesh_,
                            ShownRenderMesh(options_.render_mesh, options_.run, run_.mesh));
    if (render_mesh_.has_value()) look_.render_mesh = &*render_mesh_;
    look_.camera.azimuth = options_.azimuth;
    look_.camera.elevation = options_.elevation;
    folder_ = options_.to;
    if (folder_.empty()) {
      std::error_code error;
      folder_ = std::filesystem::is_directory(options_.run, error)
                    ? options_.run
                    : std::filesystem::path(options_.run).parent_path().string();
      if (folder_.empty()) folder_ = ".";
    }
    CLEAVE_RETURN_IF_ERROR(MakeDirectories(folder_));
    CLEAVE_ASSIGN_OR_RETURN(
        frames_,
        SelectFrames(run_.recording, 0, std::numeric_limits<int64_t>::max(), options_.stride));
    const bool neither = !options_.still.has_value() && !options_.sheet && !options_.animation &&
                         !options_.turntable.has_value();
    if (options_.still.has_value()) CLEAVE_RETURN_IF_ERROR(DrawStill(*options_.still));
    if (options_.turntable.has_value()) CLEAVE_RETURN_IF_ERROR(DrawTurntable(*options_.turntable));
    if (options_.sheet || neither) CLEAVE_RETURN_IF_ERROR(DrawSheet());
    if (options_.animation || neither) CLEAVE_RETURN_IF_ERROR(DrawAnimation());
    return absl::OkStatus();
  }

 private:
  absl::Status DrawStill(const std::string& which) {
    // The whole recording, so that stills of one run have one camera.
    CLEAVE_ASSIGN_OR_RETURN(const int64_t position, PositionOf(which, "--still"));
    CLEAVE_ASSIGN_OR_RETURN(const Image image,
                            RenderStill(run_.mesh, run_.recording.frames, position, look_));
    const int64_t frame = run_.recording.rows[static_cast<size_t>(position)].frame;
    return Write(absl::StrFormat("still_%06d.png", frame), image);
  }
  absl::Status DrawTurntable(const std::string& which) {
    CLEAVE_ASSIGN_OR_RETURN(const int64_t position, PositionOf(which, "--turntable"));
    TurntableOptions turntable;
    turntable.frames_per_second = options_.animation_look.frames_per_second;
    CLEAVE_ASSIGN_OR_RETURN(
        const std::string bytes,
        RenderTurntable(run_.mesh, run_.recording.frames, position, turntable, look_,
                        ShowingProgress("drawing the turntable", program_.interrupt)));
    const std::string path = absl::StrCat(folder_, "/turntable.webp");
    CLEAVE_RETURN_IF_ERROR(WriteAside(path, bytes));
    PrintResult(path);
    PreviewOptions look = look_;
    if (look.width == PreviewOptions().width) look.width = 480;  // of a tile
    CLEAVE_ASSIGN_OR_RETURN(
        const Image sheet,
        RenderTurntableSheet(run_.mesh, run_.recording.frames, position, turntable, look,
                             ShowingProgress("drawing the turntable's sheet", program_.interrupt)));
    return Write("turntable.png", sheet);
  }
  absl::StatusOr<int64_t> PositionOf(const std::string& which, absl::string_view option) const {
    const auto& rows = run_.recording.rows;
    int64_t frame = rows.back().frame;
    if (which != "last" && !absl::SimpleAtoi(which, &frame)) {
      return absl::InvalidArgumentError(
          absl::StrCat(option, ": \"", which, "\" is neither a frame nor last"));
    }
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const IndexRow& each) { return each.frame == frame; });
    if (row == rows.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat(option, ": frame ", frame, " is not in the recording, which has ",
                       rows.front().frame, " to ", rows.back().frame));
    }
    return row - rows.begin();
  }
  absl::Status DrawSheet() {
    PreviewOptions look = look_;
    if (look.width == PreviewOptions().width) look.width = 480;  // of a tile
    CLEAVE_ASSIGN_OR_RETURN(
        const Image image,
        RenderContactSheet(run_.mesh, frames_, options_.sheet_look, look,
                           ShowingProgress("drawing the contact sheet", program_.interrupt)));
    return Write("contact_sheet.png", image);
  }
  absl::Status DrawAnimation() {
    CLEAVE_ASSIGN_OR_RETURN(
        const std::string bytes,
        RenderAnimation(run_.mesh, frames_, options_.animation_look, look_,
                        ShowingProgress("drawing the animation", program_.interrupt)));
    const std::string path = absl::StrCat(folder_, "/preview.webp");
    CLEAVE_RETURN_IF_ERROR(WriteAside(path, bytes));
    PrintResult(path);
    return absl::OkStatus();
  }
  absl::Status Write(const std::string& name, const Image& image) {
    const std::string path = absl::StrCat(folder_, "/", name);
    CLEAVE_RETURN_IF_ERROR(WritePng(path, image));
    PrintResult(path);
    return absl::OkStatus();
  }

  Program& program_;
  const Options& options_;
  const RecordedRun& run_;
  PreviewOptions look_;
  std::optional<RenderMesh> render_mesh_;
  FrameSource frames_;
  std::string folder_;
};

absl::Status Preview(Program& program, const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(const RecordedRun run,
                          OpenRecordedRun(options.run, options.mesh, options.unit_scale));
  return Pictures(program, options, run).Draw();
}

}  // namespace

void AddPreview(CLI::App& app, Program& program) {
  CLI::App* verb =
      app.add_subcommand("preview", "Draw recorded frames: still, sheet, animation, turntable");
  auto options = std::make_shared<Options>();
  verb->add_option("run", options->run, "Folder of a run, or a .clv file")
      ->required()
      ->type_name("RUN");
  verb->add_option("--still", options->still, "Draw this frame: still_000012.png")
      ->type_name("FRAME|last");
  verb->add_flag("--sheet", options->sheet, "Draw contact_sheet.png");
  verb->add_flag("--animation", options->animation, "Draw preview.webp");
  verb->add_option("--turntable", options->turntable,
                   "Go once round this frame: turntable.webp, and 8 views in turntable.png")
      ->type_name("FRAME|last");
  verb->add_option("--to", options->to, "Folder for the pictures; default: RUN")->type_name("DIR");
  verb->add_option("--mesh", options->mesh,
                   "Mesh of the recording: a mesh or scene file; default: mesh.pb beside it")
      ->type_name("MESH");
  verb->add_option("--unit-scale", options->unit_scale, "Metres for one unit of a mesh file")
      ->check(NumberAbove(0, limits::kMaxUnitScale))
      ->capture_default_str()
      ->type_name("METRES");
  verb->add_option("--color", options->look.color_by, "What colours tell; default: region")
      ->transform(NamedValue<ColorBy>({{"region", ColorBy::kRegion},
                                       {"piece", ColorBy::kPiece},
                                       {"strain", ColorBy::kStrain},
                                       {"damage", ColorBy::kDamage},
                                       {"impurity", ColorBy::kImpurity}}))
      ->type_name("region|piece|strain|damage|impurity");
  verb->add_option("--width", options->look.width, "Pixels of a picture, or of a sheet's tile")
      ->check(CountWithin(16, kMaxImageSide))
      ->type_name("PIXELS");
  verb->add_option("--tiles", options->sheet_look.tiles, "Most pictures of a sheet")
      ->check(CountWithin(1, 400))
      ->capture_default_str();
  verb->add_option("--rate", options->animation_look.frames_per_second,
                   "Frames a second of the animation")
      ->check(NumberWithin(0.1, 120))
      ->capture_default_str();
  verb->add_option("--stride", options->stride, "Every N-th frame")
      ->check(CountWithin(1, int64_t{1} << 40))
      ->type_name("N");
  verb->add_option("--azimuth", options->azimuth, "Turns the camera round the body")
      ->type_name("DEGREES");
  verb->add_option("--elevation", options->elevation, "Lifts the camera above the ground")
      ->check(NumberWithin(-88, 88))
      ->type_name("DEGREES");
  AddRenderMeshOptions(*verb, options->render_mesh);
  verb->add_option("--title", options->look.title, "Written into the pictures");
  verb->footer(
      "Draws the sheet and the animation when nothing is chosen; prints the paths.\n"
      "Needs no display and no GPU.\n\n"
      "Examples:\n"
      "  cleave preview out/bar\n"
      "  cleave preview out/bar --still 30 --color strain --width 1920\n"
      "  cleave preview out/bar --turntable last --color piece\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return Preview(shared, *options); };
  });
}

}  // namespace cleave
