#include <memory>

#include "client/cli/console.h"
#include "client/cli/program.h"
#include "client/cli/server_access.h"
#include "client/cli/session_text.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  bool json = false;
};

absl::Status List(Program& program, const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                          ConnectServer(options.server, program.interrupt));
  CLEAVE_ASSIGN_OR_RETURN(const std::vector<v1::Session> sessions, client->ListSessions());
  for (const v1::Session& session : sessions)
    PrintResult(options.json ? MessageJson(session) : SessionText(session));
  if (sessions.empty() && !options.json) PrintNote("no sessions");
  return absl::OkStatus();
}

}  // namespace

void AddList(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand("list", "Show the sessions of a server");
  auto options = std::make_shared<Options>();
  AddServerOptions(*verb, options->server, true);
  verb->add_flag("--json", options->json, "A line of JSON a session");
  verb->footer("Example:\n  cleave list --server farm-3:7420\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return List(shared, *options); };
  });
}

}  // namespace cleave
