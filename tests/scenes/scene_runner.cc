// Runs one demonstration and prints its metrics as a line of JSON, so that many can be spread over
// machines:
//
//   scene_runner NAME VARIANT [--seed N] [--lattice] [--coarseness C] [--threads N]
//                [--picture FILE.png] [--sheet FILE.png] [--strain] [--width PIXELS]
//                [--azimuth DEGREES] [--elevation DEGREES] [--frame N]
//                [--change FILE.png]: of locality with, where it parts from locality without
//
// scene_runner alone lists names and variants.

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "client/io/preview/impurity_picture.h"
#include "client/io/preview/preview.h"
#include "client/io/preview/scene_look.h"
#include "tests/scenes/demonstration.h"
#include "tests/scenes/locality.h"

namespace cleave {
namespace {

struct Arguments {
  std::string name;
  Setting setting;
  int threads = 1;
  std::string picture;
  std::string sheet;
  std::string change;
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

void PrintLine(const Arguments& arguments, const Metrics& metrics) {
  std::printf(R"({"scene":"%s","variant":"%s","seed":%u,"layout":"%s","coarseness":%g)",
              arguments.name.c_str(), arguments.setting.variant.c_str(), arguments.setting.seed,
              arguments.setting.layout == MeshLayout::kJitteredLattice ? "lattice" : "unstructured",
              arguments.setting.coarseness);
  for (const auto& [name, value] : metrics) std::printf(R"(,"%s":%.6g)", name.c_str(), value);
  std::printf("}\n");
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

int Main(int argc, char** argv) {
  if (argc < 3) return List();
  Arguments arguments;
  arguments.name = argv[1];
  arguments.setting.variant = argv[2];
  for (int i = 3; i < argc; ++i) {
    const std::string option = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (option == "--lattice") {
      arguments.setting.layout = MeshLayout::kJitteredLattice;
      continue;
    }
    if (option == "--strain") {
      arguments.strain = true;
      continue;
    }
    if (option == "--seed")
      arguments.setting.seed = static_cast<uint32_t>(std::atoi(value));
    else if (option == "--coarseness")
      arguments.setting.coarseness = std::atof(value);
    else if (option == "--threads")
      arguments.threads = std::atoi(value);
    else if (option == "--picture")
      arguments.picture = value;
    else if (option == "--sheet")
      arguments.sheet = value;
    else if (option == "--change")
      arguments.change = value;
    else if (option == "--azimuth")
      arguments.camera.azimuth = std::atof(value);
    else if (option == "--elevation")
      arguments.camera.elevation = std::atof(value);
    else if (option == "--frame")
      arguments.frame = std::atoi(value);
    else if (option == "--width")
      arguments.width = std::atoi(value);
    else
      return List();
    ++i;
  }
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<size_t>(arguments.threads));
  const auto outcome = Demonstrate(arguments.name, arguments.setting, arguments.threads);
  if (!outcome.ok()) {
    std::fprintf(stderr, "%s\n", outcome.status().ToString().c_str());
    return 1;
  }
  PrintLine(arguments, outcome->metrics);
  if (absl::Status drawn = Draw(arguments, *outcome); !drawn.ok()) {
    std::fprintf(stderr, "%s\n", drawn.ToString().c_str());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) { return cleave::Main(argc, argv); }
