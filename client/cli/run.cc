#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/accuracy.h"
#include "client/cli/console.h"
#include "client/cli/exit_code.h"
#include "client/cli/follow.h"
#include "client/cli/goal.h"
#include "client/cli/json_line.h"
#include "client/cli/number_check.h"
#include "client/cli/products.h"
#include "client/cli/program.h"
#include "client/cli/progress.h"
#include "client/cli/run_folder.h"
#include "client/cli/scene_input.h"
#include "client/cli/server_access.h"
#include "client/cli/session_mesh.h"
#include "client/cli/session_start.h"
#include "client/io/series/write_aside.h"
#include "core/base/status.h"
#include "core/stream/rungs.h"
#include "proto/convert/rung.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  GoalOptions goal;
  AccuracyOptions accuracy;
  ProductOptions products;
  std::string scene;
  std::string out;
  int threads = 0;
  bool fresh = false;
  bool json = false;
  bool quiet = false;
};

// Whether a run that failed so is tried again: what the scene does it does again, but a disk that
// was full may have room now.
bool MayPass(const v1::Error& error) {
  return error.reason() == "DISK_FULL" || error.reason() == "INTERNAL" ||
         error.reason() == "WORKER_LOST";
}

// The run that the folder knows, or a new one.
class Run {
 public:
  Run(Program& program, const Options& options)
      : program_(program), options_(options), folder_(options.out) {}

  absl::Status Execute() {
    CLEAVE_ASSIGN_OR_RETURN(input_, LoadScene(options_.scene));
    PrintWarnings(input_.warnings);
    if (options_.fresh) CLEAVE_RETURN_IF_ERROR(folder_.Clear());
    CLEAVE_RETURN_IF_ERROR(folder_.Make());
    CLEAVE_ASSIGN_OR_RETURN(access_,
                            OpenServer(options_.server, folder_.server_data(), program_.interrupt));
    CLEAVE_RETURN_IF_ERROR(FindOrCreateSession());
    CLEAVE_RETURN_IF_ERROR(StartRunning());
    CLEAVE_ASSIGN_OR_RETURN(const FollowResult result, RecordFrames());
    CLEAVE_RETURN_IF_ERROR(KeepReports());
    return Conclude(result);
  }

 private:
  Client& client() { return *access_.client; }

  absl::Status FindOrCreateSession() {
    CLEAVE_ASSIGN_OR_RETURN(v1::Scene scene,
                            SceneForServer(client(), input_, options_.quiet || options_.json));
    if (options_.accuracy.tolerance > 0)
      scene.mutable_output()->set_tolerance(options_.accuracy.tolerance);
    if (const auto earlier = folder_.EarlierSession()) {
      CLEAVE_RETURN_IF_ERROR(folder_.CheckSameScene(scene));
      auto session = client().GetSession(*earlier);
      if (session.ok()) {
        session_ = *std::move(session);
        return CheckSameRung();
      }
      // Deleted, or the run was killed before it was created: begin anew under the same name.
      if (!absl::IsNotFound(session.status())) return session.status();
      CLEAVE_RETURN_IF_ERROR(CreateSession(SessionId(*earlier), scene));
      return absl::OkStatus();
    }
    return CreateSession(NewSessionId(options_.scene), scene);
  }

  // What the folder's session keeps cannot be changed, and what it sends is not mixed in one file.
  absl::Status CheckSameRung() const {
    const std::optional<Rung> wanted = options_.accuracy.rung();
    std::optional<Rung> kept = RungFromMessage(session_.rung());
    if (!kept && !session_.scene().output().has_tolerance()) kept = Rung::kStandard;
    if (!wanted || wanted == kept) return absl::OkStatus();
    return absl::FailedPreconditionError(
        absl::StrCat(options_.out, ": holds a run that keeps its frames at ",
                     kept ? absl::StrCat("rung ", std::string(RungName(*kept)))
                          : absl::StrCat(session_.scene().output().tolerance(), " m"),
                     "; choose another --out, or pass --fresh to throw that run away"));
  }

  absl::Status CreateSession(const std::string& id, const v1::Scene& scene) {
    CLEAVE_RETURN_IF_ERROR(folder_.Begin(SessionName(id), scene));
    v1::CreateSessionRequest request;
    request.set_session_id(id);
    *request.mutable_scene() = scene;
    request.set_threads(options_.threads);
    KeepAccuracy(options_.accuracy, request);
    auto response = client().CreateSession(std::move(request));
    if (!response.ok()) return WithLines(input_.file, response.status());
    session_ = std::move(*response->mutable_session());
    return absl::OkStatus();
  }

  absl::Status StartRunning() {
    head_ = session_.head_frame();
    scene_ = session_.scene();  // other calls leave it out
    const bool failed = session_.state() == v1::SESSION_STATE_FAILED;
    if (session_.state() == v1::SESSION_STATE_RUNNING || (failed && !MayPass(session_.error())))
      return absl::OkStatus();  // the stream tells
    const int64_t goal =
        options_.goal.frames > 0 ? options_.goal.frames : input_.scene.timing.frame_count;
    session_.set_goal_frame(goal);
    if (head_ >= goal) return absl::OkStatus();
    if (head_ > 0 && !options_.quiet && !options_.json)
      PrintNote(absl::StrCat("going on after frame ", head_, " of ", session_.name()));
    auto running = client().RunSession(session_.name(), GoalMessage(options_.goal));
    if (!running.ok()) return running.status();
    session_ = *std::move(running);
    return absl::OkStatus();
  }

  absl::StatusOr<FollowResult> RecordFrames() {
    CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Recorder> recorder,
                            Recorder::Open(folder_.frames()));
    const auto last = recorder->last();
    CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<EventFile> events,
                            EventFile::Open(folder_.events(), last.has_value() ? last->frame : -1));
    FollowOptions follow;
    follow.session = session_.name();
    follow.goal_frame = session_.goal_frame();
    follow.head_frame = head_;
    follow.pause_on_signal = true;
    follow.accuracy = options_.accuracy;
    follow.json = options_.json;
    follow.quiet = options_.quiet;
    follow.recorder = recorder.get();
    follow.events = events.get();
    // From the beginning: exports and pictures of a run that goes on, or was killed, need it.
    follow.begun = [this](const std::string& mesh_asset) {
      return KeepMeshes(client(), scene_, mesh_asset, folder_);
    };
    auto result = Follow(client(), program_.interrupt, follow);
    const absl::Status finished = recorder->Finish();
    if (!result.ok() && access_.embedded != nullptr)
      CLEAVE_RETURN_IF_ERROR(access_.embedded->Check());  // its end is the better reason
    if (result.ok()) CLEAVE_RETURN_IF_ERROR(finished);
    return result;
  }

  // Only an embedded server's are at hand.
  absl::Status KeepReports() {
    if (access_.embedded == nullptr) return absl::OkStatus();
    const std::string source =
        absl::StrCat(folder_.server_data(), "/", session_.name(), "/reports.jsonl");
    std::error_code error;
    if (!std::filesystem::exists(source, error)) return absl::OkStatus();
    // Not a copy of the file: that one is the server's alone to read.
    std::ifstream in(source, std::ios::binary);
    const std::string lines((std::istreambuf_iterator<char>(in)), {});
    if (!in) return absl::InternalError(absl::StrCat(source, " cannot be read"));
    return WriteAside(folder_.reports(), lines);
  }

  absl::Status Conclude(const FollowResult& result) {
    const bool reached = result.last_frame >= session_.goal_frame();
    if (options_.json) {
      PrintResult(JsonLine()
                      .Add("event", "end")
                      .Add("session", session_.name())
                      .Add("last_frame", result.last_frame)
                      .Add("goal_frame", session_.goal_frame())
                      .Add("time", result.last_time)
                      .Add("broken_edges", result.broken_edges)
                      .Add("pieces", result.pieces)
                      .Add("interrupted", result.interrupted && !reached)
                      .Add("frames", folder_.frames())
                      .Str());
    }
    if (result.interrupted && !reached)
      return absl::CancelledError(absl::StrCat("paused after frame ", result.last_frame, " of ",
                                               session_.goal_frame(), "; to go on:\n  ",
                                               ResumeCommand()));
    CLEAVE_RETURN_IF_ERROR(StatusOfEnd(session_.name(), result.end));
    CLEAVE_ASSIGN_OR_RETURN(const std::vector<std::string> products,
                            MakeProducts(folder_, options_.products, program_.interrupt));
    if (!options_.json) PrintFiles(products);
    if (!options_.quiet && !options_.json)
      PrintNote(absl::StrCat("frame ", result.last_frame, ", ", result.broken_edges,
                             " broken edges, ", result.pieces,
                             result.pieces == 1 ? " piece" : " pieces"));
    return absl::OkStatus();
  }

  void PrintFiles(const std::vector<std::string>& products) const {
    for (const std::string& path : {folder_.frames(), folder_.mesh(), folder_.render_mesh(),
                                    folder_.events(), folder_.reports()})
      if (std::filesystem::exists(path)) PrintResult(path);
    for (const std::string& path : products) PrintResult(path);
  }

  std::string ResumeCommand() const {
    std::string command = absl::StrCat("cleave run ", options_.scene, " --out ", options_.out);
    if (!options_.server.address.empty())
      absl::StrAppend(&command, " --server ", options_.server.address);
    return absl::StrCat(command, options_.accuracy.Words(), options_.goal.Words(),
                        options_.products.Words());
  }

  Program& program_;
  const Options& options_;
  const RunFolder folder_;
  SceneInput input_;
  ServerAccess access_;
  v1::Session session_;
  v1::Scene scene_;  // as the session has it
  int64_t head_ = -1;
};

}  // namespace

void AddRun(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand("run", "Simulate a scene and record its frames");
  auto options = std::make_shared<Options>();
  verb->add_option("scene", options->scene, "Scene file: .scene.json or .textproto")
      ->required()
      ->type_name("SCENE");
  verb->add_option("--out", options->out,
                   "Folder for the results; running again with the same one goes on where the run "
                   "stopped. Default: out/ and the scene's name")
      ->type_name("DIR");
  AddServerOptions(*verb, options->server, false);
  AddGoalOptions(*verb, options->goal);
  AddProductOptions(*verb, options->products);
  AddAccuracyOptions(*verb, options->accuracy, "that the run keeps",
                     "as the scene says, or standard");
  verb->add_option("--threads", options->threads, "Threads of the solver; 0: as the server is set")
      ->check(CountWithin(0, 1024))
      ->type_name("N");
  verb->add_flag("--fresh", options->fresh, "Throw an earlier run in DIR away first");
  verb->add_flag("--json", options->json, "A JSON line a frame on stdout, and one at the end");
  verb->add_flag("--quiet,-q", options->quiet, "No progress on stderr");
  verb->footer(
      "Leaves in DIR: frames.clv (the recorded frames), mesh.pb and, of a scene that has one,\n"
      "render_mesh.pb (for `cleave export` and `cleave preview`), events.jsonl (a line an event: "
      "edge\n"
      "breaks, splits, separations), reports.jsonl (a line of numbers a frame; private server "
      "only),\n"
      "what --vtu, --ply, --preview and --plot make; and to go on with: scene.textproto (the scene "
      "as\n"
      "it was sent), session (its name), server/ (all that the private server holds).\n"
      "Their paths are printed on stdout, one a line. Ctrl-C pauses after the frame in work,\n"
      "twice gives that frame up; the same command goes on.\n\n"
      "Examples:\n"
      "  cleave run bar.scene.json                          a private server, into out/bar\n"
      "  cleave run bar.scene.json --vtu --preview --plot\n"
      "  cleave run bar.scene.json --out wedge7 --frames 12\n"
      "  cleave run bar.scene.json --rung fine              ten times as accurate as without\n"
      "  cleave run bar.scene.json --server farm-3:7420     on a server that runs already\n");
  verb->callback([options, &program] {
    if (options->out.empty()) {
      std::string stem = std::filesystem::path(options->scene).filename().string();
      options->out = absl::StrCat("out/", stem.substr(0, stem.find('.')));
    }
    program.action = [options](Program& shared) { return Run(shared, *options).Execute(); };
  });
}

}  // namespace cleave
