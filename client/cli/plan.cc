#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/console.h"
#include "client/cli/program.h"
#include "client/cli/progress.h"
#include "client/cli/scene_input.h"
#include "client/cli/server_access.h"
#include "client/cli/session_text.h"
#include "client/cli/validate_only.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  std::string scene;
  bool json = false;
};

void PrintPlan(const v1::Plan& plan) {
  PrintResult(absl::StrCat("mesh: ", plan.node_count(), " nodes, ", plan.tet_count(), " tets, ",
                           plan.edge_count(), " edges"));
  PrintResult("parts of the model:");
  for (const v1::PlanPart& part : plan.parts())
    PrintResult(absl::StrFormat("  %-32s %10s", part.name(),
                                FormatBytes(static_cast<double>(part.bytes()))));
  PrintResult(absl::StrCat("memory: about ", FormatBytes(static_cast<double>(plan.total_bytes()))));
  PrintResult(absl::StrCat("time: about ", FormatSeconds(plan.seconds_per_frame()),
                           " a frame on one thread, ", FormatSeconds(plan.total_seconds()),
                           " in all"));
}

absl::Status ShowPlan(Program& program, const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(const SceneInput input, LoadScene(options.scene));
  PrintWarnings(input.warnings);
  std::unique_ptr<TemporaryFolder> data;
  if (options.server.address.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(data, TemporaryFolder::Create());
  }
  CLEAVE_ASSIGN_OR_RETURN(
      const ServerAccess access,
      OpenServer(options.server, data == nullptr ? "" : data->path(), program.interrupt));
  CLEAVE_ASSIGN_OR_RETURN(const v1::CreateSessionResponse response,
                          ValidateOnServer(*access.client, input, options.json));
  for (const std::string& warning : response.warnings())
    PrintNote(absl::StrCat("warning: ", warning));
  if (options.json)
    PrintResult(MessageJson(response.plan()));
  else
    PrintPlan(response.plan());
  return absl::OkStatus();
}

}  // namespace

void AddPlan(CLI::App& app, Program& program) {
  CLI::App* verb =
      app.add_subcommand("plan", "Show what a scene would build and cost; simulate nothing");
  auto options = std::make_shared<Options>();
  verb->add_option("scene", options->scene, "Scene file: .scene.json or .textproto")
      ->required()
      ->type_name("SCENE");
  AddServerOptions(*verb, options->server, false);
  verb->add_flag("--json", options->json, "As a line of JSON");
  verb->footer("Example:\n  cleave plan bar.scene.json\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return ShowPlan(shared, *options); };
  });
}

}  // namespace cleave
