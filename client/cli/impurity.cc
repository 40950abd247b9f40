#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/impurity_text.h"
#include "client/cli/number_check.h"
#include "client/cli/program.h"
#include "client/cli/scene_input.h"
#include "client/cli/server_access.h"
#include "client/cli/session_start.h"
#include "client/cli/session_text.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/scene/parse.h"
#include "client/io/series/write_aside.h"
#include "core/base/status.h"
#include "core/mesh/mesh_check.h"
#include "core/model/impurity_preview.h"
#include "core/picture/camera.h"
#include "core/picture/image.h"
#include "core/picture/impurity_picture.h"
#include "core/scene/limits.h"
#include "core/scene/validate.h"
#include "proto/convert/impurity_preview.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  std::string input;
  std::vector<std::string> layers;
  double unit_scale = 1;
  std::string out;
  bool json = false;
  ImpurityPictureOptions picture;
};

// A layer as JSON, on the command line or in a file.
absl::StatusOr<v1::ImpurityLayer> ParseLayer(const std::string& argument) {
  const bool typed = absl::StartsWith(argument, "{");
  std::string text = argument;
  if (!typed) {
    CLEAVE_ASSIGN_OR_RETURN(text, ReadFileBytes(argument));
  }
  v1::ImpurityLayer layer;
  std::map<std::string, int> lines;
  const std::vector<SceneFault> faults = ParseJsonMessage(text, layer, lines);
  if (faults.empty()) return layer;
  std::string all;
  for (const SceneFault& fault : faults) {
    absl::StrAppend(&all, all.empty() ? "" : "\n", typed ? "--layer" : argument,
                    typed ? "" : absl::StrCat(":", fault.line), ": ", fault.text);
  }
  return absl::InvalidArgumentError(all);
}

// With a picture where files are asked for, as of a server.
absl::StatusOr<v1::PreviewImpurityResponse> PreviewHere(const Options& options,
                                                        const SceneInput& input,
                                                        const TetMesh& mesh) {
  const Faults faults = ValidateSceneWithMesh(input.scene, mesh);
  if (!faults.ok()) return absl::InvalidArgumentError(input.file.Describe(faults.errors()));
  CLEAVE_ASSIGN_OR_RETURN(const ImpurityPreview preview, PreviewImpurities(input.scene, mesh));
  v1::PreviewImpurityResponse response = MessageFromPreview(preview, true);
  if (options.out.empty()) return response;
  ImpurityPictureOptions picture = options.picture;
  picture.title = input.scene.name;
  picture.camera.up = UpAgainst(input.scene.gravity);
  CLEAVE_ASSIGN_OR_RETURN(const Image image,
                          RenderImpurities(mesh, ShownImpurities(response), picture));
  CLEAVE_ASSIGN_OR_RETURN(*response.mutable_picture_png(), EncodePng(image));
  return response;
}

absl::StatusOr<v1::PreviewImpurityResponse> PreviewThere(Program& program, const Options& options,
                                                         const SceneInput& input) {
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                          ConnectServer(options.server, program.interrupt));
  v1::PreviewImpurityRequest request;
  CLEAVE_ASSIGN_OR_RETURN(*request.mutable_scene(), SceneForServer(*client, input, options.json));
  request.set_with_edges(true);
  if (!options.out.empty()) WritePictureOptions(options.picture, *request.mutable_picture());
  auto response = client->PreviewImpurity(request);
  if (!response.ok()) return WithLines(input.file, response.status());
  return response;
}

absl::Status WriteFiles(const Options& options, const TetMesh& mesh,
                        const v1::PreviewImpurityResponse& preview, const std::string& picture) {
  CLEAVE_RETURN_IF_ERROR(MakeDirectories(options.out));
  const auto write = [&](const char* name, const std::string& bytes) -> absl::Status {
    const std::string path = absl::StrCat(options.out, "/", name);
    CLEAVE_RETURN_IF_ERROR(WriteAside(path, bytes));
    PrintNote(absl::StrCat("wrote ", path));
    return absl::OkStatus();
  };
  CLEAVE_ASSIGN_OR_RETURN(const std::string potencies, PotencyVtu(mesh, preview));
  CLEAVE_RETURN_IF_ERROR(write("impurity.vtu", potencies));
  CLEAVE_ASSIGN_OR_RETURN(const std::string edges, AffectedEdgesVtu(mesh, preview));
  CLEAVE_RETURN_IF_ERROR(write("affected_edges.vtu", edges));
  return write("impurity.png", picture);
}

absl::Status ShowImpurity(Program& program, const Options& options) {
  std::vector<v1::ImpurityLayer> layers;
  for (const std::string& argument : options.layers) {
    CLEAVE_ASSIGN_OR_RETURN(layers.emplace_back(), ParseLayer(argument));
  }
  CLEAVE_ASSIGN_OR_RETURN(const SceneInput input,
                          LoadSceneWithLayers(options.input, options.unit_scale, layers));
  PrintWarnings(input.warnings);
  if (!input.scene.impurities.has_value()) {
    return absl::InvalidArgumentError(
        absl::StrCat(options.input, ": has no impurities; give layers by --layer"));
  }
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, SceneMesh(input));
  CheckAndOrientMesh(mesh);
  v1::PreviewImpurityResponse preview;
  if (options.server.address.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(preview, PreviewHere(options, input, mesh));
  } else {
    CLEAVE_ASSIGN_OR_RETURN(preview, PreviewThere(program, options, input));
  }
  const std::string picture = std::move(*preview.mutable_picture_png());
  preview.clear_picture_png();  // goes to its file
  if (options.json) {
    PrintResult(MessageJson(preview));
  } else {
    // A mesh without a scene has the strength 1.
    const bool relative = input.file.lines.empty();
    PrintResult(ImpurityText(preview, relative));
  }
  if (options.out.empty()) return absl::OkStatus();
  return WriteFiles(options, mesh, preview, picture);
}

}  // namespace

void AddImpurity(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand(
      "impurity", "Bake the impurities of a scene or mesh, show them; simulate nothing");
  auto options = std::make_shared<Options>();
  verb->add_option("input", options->input, "A scene file or a mesh file")
      ->required()
      ->type_name("INPUT");
  verb->add_option("--layer", options->layers,
                   "A further layer on top: JSON of an ImpurityLayer, or a file of it; may be "
                   "repeated. Files that it names lie beside INPUT")
      ->type_name("JSON")
      ->allow_extra_args(false);
  verb->add_option("--unit-scale", options->unit_scale, "Metres for one unit of a mesh file")
      ->check(NumberAbove(0, limits::kMaxUnitScale))
      ->capture_default_str()
      ->type_name("METRES");
  verb->add_option("--out", options->out,
                   "Write impurity.vtu, affected_edges.vtu and impurity.png here")
      ->type_name("DIR");
  verb->add_option("--width", options->picture.width,
                   "Pixels of the picture; a server draws at most 1920")
      ->check(CountWithin(16, kMaxImageSide))
      ->capture_default_str()
      ->type_name("PIXELS");
  verb->add_option("--azimuth", options->picture.camera.azimuth, "Turns the camera round the body")
      ->type_name("DEGREES");
  verb->add_option("--elevation", options->picture.camera.elevation,
                   "Lifts the camera above the ground")
      ->check(NumberWithin(-88, 88))
      ->type_name("DEGREES");
  verb->add_flag("--json", options->json, "As a line of JSON, with every node and affected edge");
  AddServerOptions(*verb, options->server, false);
  verb->get_option("--server")
      ->description("Ask this server, HOST:PORT or unix:PATH; without one the answer is made here");
  verb->footer(
      "Affected are edges whose strength impurities change; of a mesh file, strengths are shares "
      "of "
      "the pure body's.\n\n"
      "Examples:\n"
      "  cleave impurity pizza.scene.json --out out/pizza\n"
      "  cleave impurity slab.msh --out out/slab --layer '{\"strokes\": {\"curves\": [{\"points\": "
      "[0,0,1, 1,1,1]}],\n"
      "      \"depth\": 0.02}, \"potency\": 5, \"falloff\": 0.01}'\n"
      "  cleave impurity slab.msh --layer '{\"pattern\": {\"image\": {\"file\": \"star.png\"}, "
      "\"scale\": 0.5},\n"
      "      \"weakening\": 0.2}'\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return ShowImpurity(shared, *options); };
  });
}

}  // namespace cleave
