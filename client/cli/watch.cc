#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/accuracy.h"
#include "client/cli/console.h"
#include "client/cli/follow.h"
#include "client/cli/goal.h"
#include "client/cli/number_check.h"
#include "client/cli/program.h"
#include "client/cli/region.h"
#include "client/cli/run_folder.h"
#include "client/cli/server_access.h"
#include "client/cli/session_mesh.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  GoalOptions goal;
  AccuracyOptions accuracy;
  RegionOptions region;
  bool surface = false;
  std::string session;
  std::string out;
  int64_t from = 0;
  bool run = false;
  bool stay = false;
  bool latest = false;
  bool json = false;
  bool quiet = false;
};

absl::Status Record(Client& client, Interrupt& interrupt, const Options& options,
                    FollowOptions follow, const v1::Scene& scene) {
  const RunFolder folder(options.out);
  std::unique_ptr<Recorder> recorder;
  std::unique_ptr<EventFile> events;
  if (!options.out.empty()) {
    CLEAVE_RETURN_IF_ERROR(folder.Make());
    CLEAVE_ASSIGN_OR_RETURN(recorder, Recorder::Open(folder.frames()));
    const auto last = recorder->last();
    CLEAVE_ASSIGN_OR_RETURN(events,
                            EventFile::Open(folder.events(), last.has_value() ? last->frame : -1));
    follow.recorder = recorder.get();
    follow.events = events.get();
    follow.begun = [&](const std::string& mesh_asset) -> absl::Status {
      if (!std::filesystem::exists(folder.mesh())) CLEAVE_RETURN_IF_ERROR(folder.WriteScene(scene));
      return KeepMeshes(client, scene, mesh_asset, folder);
    };
  }
  const auto result = Follow(client, interrupt, follow);
  if (recorder != nullptr) CLEAVE_RETURN_IF_ERROR(recorder->Finish());
  if (!result.ok()) return result.status();
  if (result->left_out > 0 && !options.quiet && !options.json)
    PrintNote(absl::StrCat(result->left_out, " frames were left out to keep up"));
  if (recorder != nullptr && !options.json) {
    for (const std::string& path :
         {folder.frames(), folder.mesh(), folder.render_mesh(), folder.events()})
      if (std::filesystem::exists(path)) PrintResult(path);
  }
  if (result->interrupted && result->end.reason() == v1::END_REASON_UNSPECIFIED)
    return absl::CancelledError(absl::StrCat("left ", follow.session, " after frame ",
                                             result->last_frame, "; it goes on without a viewer"));
  CLEAVE_RETURN_IF_ERROR(StatusOfEnd(follow.session, result->end));
  if (result->last_frame < options.from)
    return absl::OutOfRangeError(absl::StrCat("--from: ", options.session, " ended at frame ",
                                              result->last_frame, ", before ", options.from));
  return absl::OkStatus();
}

// A run that goes on may come to the frame; one that rests does not, and has nothing to show.
absl::Status CheckFrom(const Options& options, const v1::Session& session) {
  const bool rests = session.state() == v1::SESSION_STATE_IDLE;
  const int64_t head = std::max<int64_t>(session.head_frame(), 0);  // made for its first viewer
  if (!rests || options.run || options.stay || options.from <= head) return absl::OkStatus();
  return absl::OutOfRangeError(absl::StrCat("--from: ", options.from, " is outside [0, ", head,
                                            "]: ", options.session, " rests at frame ", head));
}

absl::Status Watch(Program& program, const Options& options) {
  CLEAVE_RETURN_IF_ERROR(options.region.Check());
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                          ConnectServer(options.server, program.interrupt));
  CLEAVE_ASSIGN_OR_RETURN(v1::Session session, client->GetSession(SessionName(options.session)));
  CLEAVE_RETURN_IF_ERROR(CheckFrom(options, session));
  const int64_t head = session.head_frame();
  const v1::Scene scene = session.scene();
  if (options.run) {
    CLEAVE_ASSIGN_OR_RETURN(session, client->RunSession(session.name(), GoalMessage(options.goal)));
  }
  FollowOptions follow;
  follow.session = SessionName(options.session);
  follow.first_frame = options.from;
  follow.stay = options.stay;
  follow.latest = options.latest;
  follow.goal_frame = session.goal_frame();
  follow.head_frame = head;
  follow.accuracy = options.accuracy;
  follow.region = options.region;
  follow.surface = options.surface;
  follow.json = options.json;
  follow.quiet = options.quiet;
  return Record(*client, program.interrupt, options, follow, scene);
}

}  // namespace

void AddWatch(CLI::App& app, Program& program) {
  CLI::App* verb =
      app.add_subcommand("watch", "Follow a session that runs or has ended, and record it");
  auto options = std::make_shared<Options>();
  verb->add_option("session", options->session, "Name of the session, as `cleave list` shows it")
      ->required()
      ->type_name("SESSION");
  AddServerOptions(*verb, options->server, true);
  CLI::Option* out = verb->add_option("--out", options->out,
                                      "Folder for the recording: frames.clv, mesh.pb, "
                                      "events.jsonl, scene.textproto and, of a "
                                      "scene that has one, render_mesh.pb")
                         ->type_name("DIR");
  verb->add_option("--from", options->from,
                   "First frame; the newest key frame at or before it. One that a run has yet to "
                   "come to is waited for; beyond the end of one that rests it is refused")
      ->check(CountWithin(0, int64_t{1} << 40))
      ->type_name("FRAME");
  AddAccuracyOptions(*verb, options->accuracy, "of what is sent", "all that the session keeps");
  AddRegionOptions(*verb, options->region);
  verb->add_flag("--surface", options->surface,
                 "Only the nodes that surfaces are drawn from: for pictures, ply, obj and vtu of "
                 "large bodies, not for strains, vtu-volume or bakes");
  verb->add_flag("--run", options->run, "Let a paused session run on first");
  AddGoalOptions(*verb, options->goal);
  verb->add_flag("--stay", options->stay, "Stay when the run is over, for frames to come");
  verb->add_flag(
          "--latest", options->latest,
          "Keep up: whoever falls behind goes on at the newest key frame. What is left out is "
          "told; nothing can be recorded")
      ->excludes(out);
  verb->add_flag("--json", options->json, "A JSON line a frame on stdout, and one a gap");
  verb->add_flag("--quiet,-q", options->quiet, "No progress on stderr");
  verb->footer(
      "Ctrl-C leaves; the session goes on. With --out, a later `watch` with the same folder goes\n"
      "on where the recording ends. Coarser frames than the session keeps are encoded once for "
      "all\n"
      "who watch them; finer ones than it keeps there are none (exit code 7). A region is encoded\n"
      "for whoever looks at it, at best at twice the tolerance that the session keeps.\n\n"
      "Examples:\n"
      "  cleave watch bar-3f2a1c --server farm-3:7420 --out out/bar\n"
      "  cleave watch bar-3f2a1c --server farm-3:7420 --rung preview --out out/small\n"
      "  cleave watch bar-3f2a1c --server farm-3:7420 --region-box 0 0 0 1 1 1 --outside 0.01\n"
      "  cleave watch bar-3f2a1c --server farm-3:7420 --latest   where the run is, not how it "
      "went\n"
      "  cleave watch bar-3f2a1c --server farm-3:7420 --run      wake a paused session\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return Watch(shared, *options); };
  });
}

}  // namespace cleave
