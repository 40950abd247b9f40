#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/accuracy.h"
#include "client/cli/console.h"
#include "client/cli/goal.h"
#include "client/cli/number_check.h"
#include "client/cli/program.h"
#include "client/cli/scene_input.h"
#include "client/cli/server_access.h"
#include "client/cli/session_start.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  GoalOptions goal;
  AccuracyOptions accuracy;
  std::string scene;
  std::string session;
  int threads = 0;
  bool idle = false;
};

absl::Status Submit(Program& program, const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(const SceneInput input, LoadScene(options.scene));
  PrintWarnings(input.warnings);
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                          ConnectServer(options.server, program.interrupt));
  v1::CreateSessionRequest request;
  CLEAVE_ASSIGN_OR_RETURN(*request.mutable_scene(), SceneForServer(*client, input, false));
  request.set_session_id(options.session.empty() ? NewSessionId(options.scene)
                                                 : SessionId(options.session));
  request.set_threads(options.threads);
  KeepAccuracy(options.accuracy, request);
  const auto created = client->CreateSession(std::move(request));
  if (!created.ok()) return WithLines(input.file, created.status());
  const std::string& name = created->session().name();
  if (!options.idle)
    CLEAVE_RETURN_IF_ERROR(client->RunSession(name, GoalMessage(options.goal)).status());
  PrintResult(name);
  PrintNote(absl::StrCat(options.idle ? "created" : "running", "; to see it: cleave watch ", name,
                         " --server ", client->address()));
  return absl::OkStatus();
}

}  // namespace

void AddSubmit(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand("submit", "Start a run on a server and leave it there");
  auto options = std::make_shared<Options>();
  verb->add_option("scene", options->scene, "Scene file: .scene.json or .textproto")
      ->required()
      ->type_name("SCENE");
  AddServerOptions(*verb, options->server, true);
  AddGoalOptions(*verb, options->goal);
  AddAccuracyOptions(*verb, options->accuracy, "that the session keeps, the finest for viewers",
                     "as the scene says, or standard");
  verb->add_option(
          "--session", options->session,
          "Name of the session: a letter and 2 to 62 of a-z, 0-9 and -; default: the scene's "
          "name and some digits")
      ->type_name("NAME");
  verb->add_option("--threads", options->threads, "Threads of the solver; 0: as the server is set")
      ->check(CountWithin(0, 1024))
      ->type_name("N");
  verb->add_flag("--idle", options->idle, "Only create the session, for `cleave step`");
  verb->footer(
      "Prints the session's name on stdout. The run goes on when this program has ended.\n\n"
      "Examples:\n"
      "  cleave submit bar.scene.json --server farm-3:7420\n"
      "  name=$(cleave submit bar.scene.json --server farm-3:7420 2>/dev/null)\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return Submit(shared, *options); };
  });
}

}  // namespace cleave
