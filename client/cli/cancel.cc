#include <memory>

#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/program.h"
#include "client/cli/server_access.h"
#include "client/cli/session_text.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  std::string session;
  bool after_frame = false;
  bool remove = false;
};

absl::Status Cancel(Program& program, const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                          ConnectServer(options.server, program.interrupt));
  const std::string name = SessionName(options.session);
  if (options.remove) {
    CLEAVE_RETURN_IF_ERROR(client->DeleteSession(name, false));
    PrintNote(absl::StrCat("deleted ", name));
    return absl::OkStatus();
  }
  CLEAVE_ASSIGN_OR_RETURN(const v1::Session session,
                          client->PauseSession(name, !options.after_frame));
  PrintResult(SessionText(session));
  PrintNote(absl::StrCat("to go on: cleave watch ", SessionId(name), " --run --server ",
                         client->address()));
  return absl::OkStatus();
}

}  // namespace

void AddCancel(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand("cancel", "Stop a session's run, or delete the session");
  auto options = std::make_shared<Options>();
  verb->add_option("session", options->session, "Name of the session")
      ->required()
      ->type_name("SESSION");
  AddServerOptions(*verb, options->server, true);
  CLI::Option* after = verb->add_flag("--after-frame", options->after_frame,
                                      "Finish the frame in work instead of giving it up");
  verb->add_flag("--delete", options->remove, "Remove the session and all its frames")
      ->excludes(after);
  verb->footer(
      "A session that was stopped keeps its frames and may run on.\n\n"
      "Examples:\n"
      "  cleave cancel bar-3f2a1c --server farm-3:7420\n"
      "  cleave cancel bar-3f2a1c --server farm-3:7420 --delete\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return Cancel(shared, *options); };
  });
}

}  // namespace cleave
