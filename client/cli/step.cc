#include <algorithm>
#include <atomic>
#include <csignal>
#include <memory>

#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/exit_code.h"
#include "client/cli/interrupt.h"
#include "client/cli/number_check.h"
#include "client/cli/program.h"
#include "client/cli/server_access.h"
#include "client/cli/session_text.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  std::string session;
  int64_t frames = 1;
  double seconds = 600;
  bool json = false;
};

// As many calls as the server's limit on one asks for.
absl::Status Step(Program& program, const Options& options) {
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                          ConnectServer(options.server, program.interrupt));
  const std::string name = SessionName(options.session);
  CLEAVE_ASSIGN_OR_RETURN(v1::Session session, client->GetSession(name));
  const int64_t limit = std::max<int64_t>(1, client->server().limits().max_step_frames());
  const auto budget = std::chrono::milliseconds(static_cast<int64_t>(options.seconds * 1000));
  int64_t done = 0;
  // As `run` takes signals: the first pauses behind the frame in work, a second gives that up.
  std::atomic<bool> interrupted{false};
  const ScopedHandler handler(program.interrupt, [&](int signal, int count) {
    interrupted = true;
    const auto paused = client->PauseSession(name, signal == SIGTERM || count > 1);
    if (!paused.ok() && !absl::IsFailedPrecondition(paused.status())) PrintError(paused.status());
  });
  while (done < options.frames && !interrupted && !program.interrupt.stop().requested()) {
    const auto frames = static_cast<uint32_t>(std::min(limit, options.frames - done));
    CLEAVE_ASSIGN_OR_RETURN(
        const v1::StepSessionResponse response,
        client->StepSession(name, frames, std::max<int64_t>(0, session.head_frame()), budget));
    session = response.session();
    done += response.frames_done();
    if (session.state() == v1::SESSION_STATE_FAILED)
      return SimulationFailed(absl::StrCat(name, " failed after frame ", session.head_frame(), ": ",
                                           session.error().message()));
    if (!interrupted && (response.deadline_reached() || response.frames_done() == 0))
      return absl::DeadlineExceededError(absl::StrCat(
          name, ": ", done, " of ", options.frames,
          " frames were done within the time; it stands at ", "frame ", session.head_frame()));
  }
  PrintResult(options.json ? MessageJson(session) : SessionText(session));
  if (done < options.frames)
    return absl::CancelledError(absl::StrCat("stopped after ", done, " frames"));
  return absl::OkStatus();
}

}  // namespace

void AddStep(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand("step", "Advance an idle session by some frames");
  auto options = std::make_shared<Options>();
  verb->add_option("session", options->session, "Name of the session")
      ->required()
      ->type_name("SESSION");
  AddServerOptions(*verb, options->server, true);
  verb->add_option("--frames,-n", options->frames, "How many")
      ->check(CountWithin(1, int64_t{1} << 40))
      ->capture_default_str()
      ->type_name("N");
  verb->add_option("--timeout", options->seconds, "Longest time of one call")
      ->check(NumberWithin(0.01, 1e6))
      ->capture_default_str()
      ->type_name("SECONDS");
  verb->add_flag("--json", options->json, "The session as a line of JSON");
  verb->footer(
      "Examples:\n"
      "  cleave submit bar.scene.json --server farm-3:7420 --idle --session bar\n"
      "  cleave step bar --server farm-3:7420 -n 5\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return Step(shared, *options); };
  });
}

}  // namespace cleave
