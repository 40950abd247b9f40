// Runs one demonstration and prints its metrics as a line of JSON, so that many can be spread over
// machines:
//
//   scene_runner NAME VARIANT [--seed N] [--lattice] [--coarseness C] [--threads N]
//                [--picture FILE.png] [--sheet FILE.png] [--strain] [--width PIXELS]
//                [--azimuth DEGREES] [--elevation DEGREES] [--frame N]
//                [--change FILE.png]: of locality with, where it parts from locality without
//                [--forces FILE.svg [--beside VARIANT,VARIANT...]]: force over displacement of
//                what is pulled, and of other variants of the same seed
//
//   scene_runner NAME --judge < LINES: holds such lines against the scene's criteria
//   scene_runner --list: scenes, variants and criteria as JSON
//
// scene_runner alone lists names and variants. scene_json.h has the forms.

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/io/plot/force_plot.h"
#include "client/io/preview/preview.h"
#include "client/io/preview/scene_look.h"
#include "client/io/series/write_aside.h"
#include "core/base/status.h"
#include "core/picture/impurity_picture.h"
#include "tests/scenes/demonstration.h"
#include "tests/scenes/locality.h"
#include "tests/scenes/scene_json.h"

namespace cleave {
namespace {

struct Arguments {
  std::string name;
  Setting setting;
  int threads = 1;
  std::string picture;
  std::string sheet;
  std::string change;
  std::string forces;
  std::string beside;  // variants, parted by commas
  bool strain = false;
  int width = 800;  // pixels
  CameraOptions camera;
  int64_t frame = -1;  // of the picture; -1: the last
};

int List() {
  for (const DemonstrationKind& kind : DemonstrationKinds()) {
    std::printf("%s (%s):", kind.name.c_str(), kind.paper.c_str());
    for (const std::string& variant : kind.variants) std::printf(" %s", variant.c_str());
    std::printf("\n");
  }
  return 2;
}

int Fail(const absl::Status& status) {
  std::fprintf(stderr, "%s\n", std::string(status.message()).c_str());
  return 1;
}

// Holds runs, read from standard input, against the criteria of their scene.
int JudgeRuns(const std::string& name) {
  const auto kind = FindDemonstration(name);
  if (!kind.ok()) return Fail(kind.status());
  const std::string lines{std::istreambuf_iterator<char>(std::cin), {}};
  const auto trials = ReadTrials(**kind, lines);
  if (!trials.ok()) return Fail(trials.status());
  std::printf("%s\n", FindingsJson(**kind, *trials).c_str());
  return 0;
}

// Where the bodies of S6 begin to part: changes of velocity over four decades.
absl::Status DrawChange(const Arguments& arguments, const Outcome& with) {
  Setting setting = arguments.setting;
  setting.variant = "without";
  const auto without = Demonstrate(arguments.name, setting, arguments.threads);
  if (!without.ok()) return without.status();
  const TetMesh& mesh = with.demonstration.mesh;
  const LocalityOfChange change =
      CompareRuns(with.demonstration, BuildIncidence(mesh), without->run, with.run);
  constexpr double kDecades = 4;
  std::vector<double> shares(mesh.rest_positions.size(), 0);
  for (size_t node = 0; node < change.speeds.size(); ++node) {
    const double decades = std::log10(change.speeds[node] / change.largest);
    shares[node] = std::clamp(1 + decades / kDecades, 0.0, 1.0);
  }
  ImpurityPictureOptions options;
  options.width = arguments.width;
  options.camera = arguments.camera;
  options.title = "change of velocity by one impure node";
  options.low = "1e-4 and less";
  options.high = "largest";
  const auto image = RenderImpurities(mesh, shares, options);
  if (!image.ok()) return image.status();
  return WritePng(arguments.change, *image);
}

absl::StatusOr<ForceCurve> ForcesOf(const std::string& variant, const Outcome& outcome) {
  const Demonstration& made = outcome.demonstration;
  ForceCurve curve{variant, {}, outcome.run.PullForces(made)};
  if (curve.force.empty() || made.pulled.empty())
    return absl::InvalidArgumentError(absl::StrCat("nothing pulls ", variant));
  for (size_t k = 0; k < curve.force.size(); ++k) {
    double way = 0;
    for (const int32_t node : made.pulled) {
      const Vec3& now = outcome.run.frames[k + 1].positions[static_cast<size_t>(node)];
      const Vec3& rest = made.mesh.rest_positions[static_cast<size_t>(node)];
      for (size_t axis = 0; axis < 3; ++axis)
        way += (now[axis] - rest[axis]) * made.pull_direction[axis];
    }
    curve.displacement.push_back(way / static_cast<double>(made.pulled.size()));
  }
  return curve;
}

absl::Status DrawForces(const Arguments& arguments, const Outcome& outcome) {
  std::vector<ForceCurve> curves;
  CLEAVE_ASSIGN_OR_RETURN(ForceCurve first, ForcesOf(arguments.setting.variant, outcome));
  curves.push_back(std::move(first));
  for (const auto variant : absl::StrSplit(arguments.beside, ',', absl::SkipEmpty())) {
    Setting setting = arguments.setting;
    setting.variant = std::string(variant);
    CLEAVE_ASSIGN_OR_RETURN(const Outcome other,
                            Demonstrate(arguments.name, setting, arguments.threads));
    CLEAVE_ASSIGN_OR_RETURN(ForceCurve curve, ForcesOf(setting.variant, other));
    curves.push_back(std::move(curve));
  }
  CLEAVE_ASSIGN_OR_RETURN(const auto* kind, FindDemonstration(arguments.name));
  CLEAVE_ASSIGN_OR_RETURN(const std::string svg, EncodeForcePlot(curves, kind->title));
  return WriteAside(arguments.forces, svg);
}

absl::Status Draw(const Arguments& arguments, const Outcome& outcome) {
  const std::vector<Frame>& frames = outcome.run.frames;
  FrameSource source;
  source.count = static_cast<int64_t>(frames.size());
  source.read = [&](int64_t position) -> absl::StatusOr<Frame> {
    return frames[static_cast<size_t>(position)];
  };
  PreviewOptions options;
  options.width = arguments.width;
  options.samples = 3;
  options.camera = arguments.camera;
  ApplySceneLook(outcome.demonstration.scene, outcome.demonstration.mesh, options);
  if (!arguments.change.empty()) {
    if (absl::Status drawn = DrawChange(arguments, outcome); !drawn.ok()) return drawn;
  }
  if (!arguments.forces.empty()) {
    if (absl::Status drawn = DrawForces(arguments, outcome); !drawn.ok()) return drawn;
  }
  if (arguments.strain) options.color_by = ColorBy::kStrain;
  if (!arguments.picture.empty()) {
    const int64_t last = source.count - 1;
    const int64_t position = arguments.frame < 0 ? last : std::min(arguments.frame, last);
    const auto image = RenderStill(outcome.demonstration.mesh, source, position, options);
    if (!image.ok()) return image.status();
    if (absl::Status written = WritePng(arguments.picture, *image); !written.ok()) return written;
  }
  if (!arguments.sheet.empty()) {
    SheetOptions sheet;
    sheet.tiles = 6;
    const auto image =
        RenderContactSheet(outcome.demonstration.mesh, source, sheet, options, nullptr);
    if (!image.ok()) return image.status();
    if (absl::Status written = WritePng(arguments.sheet, *image); !written.ok()) return written;
  }
  return absl::OkStatus();
}

// NotFound for an option that there is not; InvalidArgument for a value that it cannot have.
absl::Status ReadOption(const std::string& option, const std::string& value, Arguments& arguments) {
  const std::map<std::string, std::string*> words = {{"--picture", &arguments.picture},
                                                     {"--sheet", &arguments.sheet},
                                                     {"--change", &arguments.change},
                                                     {"--forces", &arguments.forces},
                                                     {"--beside", &arguments.beside}};
  if (const auto word = words.find(option); word != words.end()) {
    *word->second = value;
    return value.empty() ? absl::InvalidArgumentError(absl::StrCat(option, " needs a value"))
                         : absl::OkStatus();
  }
  bool read = false;
  double number = 0;
  if (option == "--seed")
    read = absl::SimpleAtoi(value, &arguments.setting.seed);
  else if (option == "--coarseness")
    read = absl::SimpleAtod(value, &arguments.setting.coarseness) &&
           arguments.setting.coarseness >= 0.1 && arguments.setting.coarseness <= 100;
  else if (option == "--threads")
    read = absl::SimpleAtoi(value, &arguments.threads) && arguments.threads >= 1;
  else if (option == "--frame")
    read = absl::SimpleAtoi(value, &arguments.frame);
  else if (option == "--width")
    read = absl::SimpleAtoi(value, &arguments.width);
  else if (option == "--azimuth" && (read = absl::SimpleAtod(value, &number)))
    arguments.camera.azimuth = number;
  else if (option == "--elevation" && (read = absl::SimpleAtod(value, &number)))
    arguments.camera.elevation = number;
  else if (option != "--azimuth" && option != "--elevation")
    return absl::NotFoundError(absl::StrCat("there is no option ", option));
  return read ? absl::OkStatus()
              : absl::InvalidArgumentError(absl::StrCat(option, " cannot be \"", value, "\""));
}

int Main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "--list") {
    std::printf("%s\n", KindsJson().c_str());
    return 0;
  }
  if (argc < 3) return List();
  Arguments arguments;
  arguments.name = argv[1];
  if (std::string(argv[2]) == "--judge") return JudgeRuns(arguments.name);
  arguments.setting.variant = argv[2];
  for (int i = 3; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--lattice") {
      arguments.setting.layout = MeshLayout::kJitteredLattice;
    } else if (option == "--strain") {
      arguments.strain = true;
    } else {
      const std::string value = ++i < argc ? argv[i] : "";
      if (absl::Status read = ReadOption(option, value, arguments); !read.ok()) return Fail(read);
    }
  }
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<size_t>(arguments.threads));
  const auto outcome = Demonstrate(arguments.name, arguments.setting, arguments.threads);
  if (!outcome.ok()) return Fail(outcome.status());
  // The line says that all is done, pictures too.
  if (absl::Status drawn = Draw(arguments, *outcome); !drawn.ok()) return Fail(drawn);
  std::printf("%s\n", RunJson(arguments.name, arguments.setting, outcome->metrics).c_str());
  return 0;
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) { return cleave::Main(argc, argv); }
