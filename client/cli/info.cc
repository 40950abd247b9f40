#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/console.h"
#include "client/cli/program.h"
#include "client/cli/progress.h"
#include "client/cli/server_access.h"
#include "client/cli/session_text.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  bool json = false;
};

absl::Status Info(Program& program, const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                          ConnectServer(options.server, program.interrupt));
  const v1::ServerInfo& info = client->server();
  if (options.json) {
    PrintResult(MessageJson(info));
    return absl::OkStatus();
  }
  const v1::ServerLimits& limits = info.limits();
  PrintResult(absl::StrCat("server      ", client->address(), ", version ", info.server_version()));
  PrintResult(absl::StrCat("protocols   ", absl::StrJoin(info.api_versions(), ", ")));
  PrintResult(absl::StrCat("instance    ", info.instance_id()));
  PrintResult(absl::StrCat("features    ", absl::StrJoin(info.features(), ", ")));
  PrintResult(absl::StrCat("largest     ", limits.max_tets_per_session(), " tets a session, ",
                           FormatBytes(static_cast<double>(limits.max_asset_bytes())), " a mesh, ",
                           limits.max_step_frames(), " frames a step call"));
  return absl::OkStatus();
}

}  // namespace

void AddInfo(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand("info", "Show a server's version and limits");
  auto options = std::make_shared<Options>();
  AddServerOptions(*verb, options->server, true);
  verb->add_flag("--json", options->json, "As a line of JSON");
  verb->footer("Example:\n  cleave info --server farm-3:7420 && echo it answers\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return Info(shared, *options); };
  });
}

}  // namespace cleave
