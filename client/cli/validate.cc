#include <memory>

#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/program.h"
#include "client/cli/scene_input.h"
#include "client/cli/server_access.h"
#include "client/cli/validate_only.h"
#include "core/base/status.h"
#include "core/mesh/mesh_check.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  std::string scene;
};

// What LoadScene leaves open: the mesh of a procedural scene, built here to be looked at.
absl::Status CheckProceduralMesh(const SceneInput& input) {
  if (input.mesh.has_value() || input.file.scene.mesh().has_asset()) return absl::OkStatus();
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, SceneMesh(input));
  CLEAVE_RETURN_IF_ERROR(CheckAndOrientMesh(mesh).ToStatus());
  const Faults faults = CheckWithBody(input, mesh);
  PrintWarnings(faults.warnings());
  if (faults.ok()) return absl::OkStatus();
  return absl::InvalidArgumentError(input.file.Describe(faults.errors()));
}

absl::Status Validate(Program& program, const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(const SceneInput input, LoadScene(options.scene));
  PrintWarnings(input.warnings);
  CLEAVE_RETURN_IF_ERROR(CheckProceduralMesh(input));
  if (!options.server.address.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                            ConnectServer(options.server, program.interrupt));
    CLEAVE_ASSIGN_OR_RETURN(const v1::CreateSessionResponse response,
                            ValidateOnServer(*client, input, false));
    for (const std::string& warning : response.warnings())
      PrintNote(absl::StrCat("warning: ", warning));
  }
  PrintNote(absl::StrCat(options.scene, " is valid"));
  return absl::OkStatus();
}

}  // namespace

void AddValidate(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand("validate", "Check a scene and its mesh; report every fault");
  auto options = std::make_shared<Options>();
  verb->add_option("scene", options->scene, "Scene file: .scene.json or .textproto")
      ->required()
      ->type_name("SCENE");
  ServerOptions& server = options->server;
  verb->add_option("--server", server.address,
                   "Let this server check it too: HOST:PORT or unix:PATH")
      ->envname("CLEAVE_SERVER")
      ->type_name("ADDRESS");
  verb->footer(
      "Every fault is a line on stderr, with the file's line: bar.scene.json:14: ...\n"
      "Exit code 0: valid; 3: not.\n\n"
      "Example:\n  cleave validate bar.scene.json\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return Validate(shared, *options); };
  });
}

}  // namespace cleave
