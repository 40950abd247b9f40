#include "client/io/gallery/gallery.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/child_program.h"
#include "client/cli/console.h"
#include "client/cli/gallery_runs.h"
#include "client/cli/json_line.h"
#include "client/cli/number_check.h"
#include "client/cli/program.h"
#include "client/cli/progress.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/series/write_aside.h"
#include "core/base/status.h"
#include "core/picture/image.h"

namespace cleave {
namespace {

struct Options {
  std::vector<std::string> scenes;
  std::string out;
  std::string seeds = "2-6";
  std::string layout = "both";
  double coarseness = 1;
  int width = 800;  // pixels
  int threads = 1;
  int jobs = 1;
  std::string runner;
  bool fresh = false;
};

constexpr int kLookAtInterrupt = 200;  // ms

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string Describe(const GalleryRun& run) {
  return absl::StrCat(run.scene, " ", run.variant, ", seed ", run.seed, ", ", run.layout);
}

// Those of `all` that are named, in their order there; all where none is.
absl::StatusOr<std::vector<GalleryScene>> Chosen(std::vector<GalleryScene> all,
                                                 const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const GalleryScene& scene : all) known.push_back(scene.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      return absl::NotFoundError(absl::StrCat("there is no scene \"", name,
                                              "\"; there are: ", absl::StrJoin(known, ", ")));
    }
  }
  if (names.empty()) return all;
  std::erase_if(all, [&](const GalleryScene& scene) {
    return std::find(names.begin(), names.end(), scene.name) == names.end();
  });
  return all;
}

// Runs what the folder does not have yet, a few at a time, and writes the page.
class GalleryMaker {
 public:
  GalleryMaker(Program& program, const Options& options) : program_(program), options_(options) {}

  absl::Status Make() {
    CLEAVE_ASSIGN_OR_RETURN(const std::vector<uint32_t> seeds, ParseSeeds(options_.seeds));
    runner_ = options_.runner;
    if (runner_.empty()) {
      CLEAVE_ASSIGN_OR_RETURN(runner_, FindSceneRunner());
    }
    CLEAVE_ASSIGN_OR_RETURN(gallery_.build, BuildOf(runner_));
    CLEAVE_ASSIGN_OR_RETURN(const std::string list, Ask({"--list"}, ""));
    CLEAVE_ASSIGN_OR_RETURN(std::vector<GalleryScene> scenes, ParseSceneList(list));
    CLEAVE_ASSIGN_OR_RETURN(gallery_.scenes, Chosen(std::move(scenes), options_.scenes));
    std::vector<std::string> layouts = {"lattice", "unstructured"};
    if (options_.layout != "both") layouts = {options_.layout};
    gallery_.settings = absl::StrCat(
        "seeds ", options_.seeds, "; ", absl::StrJoin(layouts, " and "),
        layouts.size() > 1 ? " meshes" : " mesh", "; coarseness ", options_.coarseness);
    folder_ = std::make_unique<GalleryFolder>(options_.out, gallery_.build, options_.width);
    if (options_.fresh) CLEAVE_RETURN_IF_ERROR(folder_->Clear());
    CLEAVE_RETURN_IF_ERROR(folder_->Make());
    for (const GalleryScene& scene : gallery_.scenes) {
      if (scene.coarsest < options_.coarseness) {
        PrintNote(absl::StrCat(scene.name, " runs at coarseness ", scene.coarsest,
                               ", the coarsest that it takes"));
      }
    }
    const std::vector<GalleryRun> runs =
        RunsOf(gallery_.scenes, seeds, layouts, options_.coarseness);
    CLEAVE_RETURN_IF_ERROR(RunAll(runs));
    CLEAVE_RETURN_IF_ERROR(WritePage(runs));
    return Conclude(runs.size());
  }

 private:
  struct Running {
    GalleryRun run;
    double since = 0;  // s
    std::unique_ptr<ChildProgram> child;
  };

  absl::StatusOr<std::string> Ask(std::vector<std::string> words, absl::string_view input) {
    words.insert(words.begin(), runner_);
    CLEAVE_ASSIGN_OR_RETURN(const auto child, ChildProgram::Start(words, input));
    return child->Output();
  }

  GalleryScene& SceneOf(const GalleryRun& run) {
    return *std::find_if(gallery_.scenes.begin(), gallery_.scenes.end(),
                         [&](const GalleryScene& scene) { return scene.name == run.scene; });
  }

  absl::StatusOr<Running> Start(const GalleryRun& run) {
    std::vector<std::string> words = {runner_,
                                      run.scene,
                                      run.variant,
                                      "--seed",
                                      absl::StrCat(run.seed),
                                      "--coarseness",
                                      absl::StrCat(run.coarseness),
                                      "--threads",
                                      absl::StrCat(options_.threads)};
    if (run.layout == "lattice") words.push_back("--lattice");
    if (run.pictured) {
      words.insert(words.end(), {"--picture", folder_->PicturePath(run), "--width",
                                 absl::StrCat(options_.width)});
    }
    Running running{run, Now(), nullptr};
    CLEAVE_ASSIGN_OR_RETURN(running.child, ChildProgram::Start(words));
    return running;
  }

  // Keeps what a run that has ended printed, or that it failed.
  absl::Status Collect(Running& running) {
    ++ended_;
    const absl::StatusOr<std::string> output = running.child->Output();
    PrintNote(absl::StrFormat("[%d/%d] %s: %s", ended_, to_do_, Describe(running.run),
                              output.ok() ? FormatSeconds(Now() - running.since)
                                          : std::string(output.status().message())));
    if (output.ok()) {
      lines_[running.run.scene] += *output;
      ++SceneOf(running.run).runs_done;
      return folder_->Keep(running.run, *output);
    }
    // It meets nothing; the next time it is tried again.
    ++failed_;
    const GalleryRun& run = running.run;
    JsonLine line;
    line.Add("scene", run.scene).Add("variant", run.variant).Add("layout", run.layout);
    line.Add("seed", int64_t{run.seed}).Add("coarseness", run.coarseness);
    line.Add("error", output.status().message());
    absl::StrAppend(&lines_[run.scene], line.Str(), "\n");
    SceneOf(run).failures.push_back(absl::StrCat(Describe(run), ": ", output.status().message()));
    return absl::OkStatus();
  }

  absl::Status RunAll(const std::vector<GalleryRun>& runs) {
    std::deque<GalleryRun> left;
    for (const GalleryRun& run : runs) {
      GalleryScene& scene = SceneOf(run);
      ++scene.runs;
      const std::string kept = folder_->Find(run);
      if (kept.empty()) {
        left.push_back(run);
        continue;
      }
      lines_[run.scene] += kept;
      ++scene.runs_done;
    }
    to_do_ = static_cast<int64_t>(left.size());
    if (to_do_ < static_cast<int64_t>(runs.size()))
      PrintNote(absl::StrCat(runs.size() - left.size(), " of ", runs.size(), " runs are there"));
    const auto stopped = [&] { return program_.interrupt.stop().requested(); };
    std::vector<Running> running;
    while (!stopped() && (!left.empty() || !running.empty())) {
      while (!left.empty() && running.size() < static_cast<size_t>(options_.jobs)) {
        CLEAVE_ASSIGN_OR_RETURN(running.emplace_back(), Start(left.front()));
        left.pop_front();
      }
      std::vector<const ChildProgram*> children;
      for (const Running& each : running) children.push_back(each.child.get());
      ChildProgram::AwaitAny(children, kLookAtInterrupt);
      for (size_t i = 0; i < running.size();) {
        if (!running[i].child->Ended()) {
          ++i;
          continue;
        }
        CLEAVE_RETURN_IF_ERROR(Collect(running[i]));
        running.erase(running.begin() + static_cast<ptrdiff_t>(i));
      }
    }
    return absl::OkStatus();  // what still runs is ended; it has nothing to lose but itself
  }

  absl::Status WritePage(const std::vector<GalleryRun>& runs) {
    for (GalleryScene& scene : gallery_.scenes) {
      if (lines_[scene.name].empty()) continue;
      CLEAVE_ASSIGN_OR_RETURN(const std::string findings,
                              Ask({scene.name, "--judge"}, lines_[scene.name]));
      CLEAVE_ASSIGN_OR_RETURN(scene.groups, ParseFindings(findings));
    }
    for (const GalleryRun& run : runs) {
      if (!run.pictured || folder_->Find(run).empty()) continue;
      const std::string path = folder_->PicturePath(run);
      GalleryPicture picture;
      picture.variant = run.variant;
      CLEAVE_ASSIGN_OR_RETURN(picture.png, ReadFileBytes(path));
      GalleryScene& scene = SceneOf(run);
      picture.control = std::find(scene.controls.begin(), scene.controls.end(), run.variant) !=
                        scene.controls.end();
      scene.pictures.push_back(std::move(picture));
    }
    CLEAVE_RETURN_IF_ERROR(WriteAside(folder_->table(), VerdictTable(gallery_)));
    CLEAVE_RETURN_IF_ERROR(WriteAside(folder_->page(), GalleryPage(gallery_)));
    PrintResult(folder_->page());
    PrintResult(folder_->table());
    return absl::OkStatus();
  }

  absl::Status Conclude(size_t runs) {
    const VerdictCount count = CountVerdicts(gallery_);
    PrintNote(absl::StrCat(count.good, " of ", count.all, " verdicts are as they should be"));
    if (program_.interrupt.stop().requested()) {
      int64_t done = 0;
      for (const GalleryScene& scene : gallery_.scenes) done += scene.runs_done;
      return absl::CancelledError(absl::StrCat("stopped after ", done, " of ", runs,
                                               " runs; the same command goes on from there"));
    }
    if (failed_ == 0) return absl::OkStatus();
    return absl::InternalError(absl::StrCat(failed_, " of ", runs, " runs failed"));
  }

  Program& program_;
  const Options& options_;
  std::string runner_;
  Gallery gallery_;
  std::unique_ptr<GalleryFolder> folder_;
  std::map<std::string, std::string> lines_;  // of runs, by scene
  int64_t to_do_ = 0, ended_ = 0, failed_ = 0;
};

}  // namespace

void AddGallery(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand(
      "gallery", "Rerun the paper's scenes; write a page of pictures, criteria and verdicts");
  auto options = std::make_shared<Options>();
  verb->add_option("scenes", options->scenes, "Names of scenes; default: all")->type_name("SCENE");
  verb->add_option("--out", options->out, "Folder for the page, pictures and runs")
      ->required()
      ->type_name("DIR");
  verb->add_option("--seeds", options->seeds, "Seeds of each: 2-6 or 1,4,7")
      ->capture_default_str()
      ->type_name("SEEDS");
  verb->add_option("--layout", options->layout, "Meshes")
      ->check(CLI::IsMember({"lattice", "unstructured", "both"}))
      ->capture_default_str();
  verb->add_option("--coarseness", options->coarseness,
                   "Cells so many times as long as at full size, or as long as the scene takes: "
                   "2 is some 8 to 16 times as fast")
      ->check(NumberWithin(0.1, 100))
      ->capture_default_str()
      ->type_name("FACTOR");
  verb->add_option("--width", options->width, "Pixels of a picture")
      ->check(CountWithin(16, kMaxImageSide))
      ->capture_default_str()
      ->type_name("PIXELS");
  verb->add_option("--threads", options->threads, "Threads of each run; results do not change")
      ->check(CountWithin(1, 1024))
      ->capture_default_str()
      ->type_name("N");
  verb->add_option("--jobs", options->jobs, "Runs at a time")
      ->check(CountWithin(1, 256))
      ->capture_default_str()
      ->type_name("N");
  verb->add_option("--runner", options->runner,
                   "The scene runner; default: the one that was built "
                   "or installed with this program")
      ->type_name("PROGRAM");
  verb->add_flag("--fresh", options->fresh, "Run all anew");
  verb->footer(
      "Runs that the folder has from the same build and settings are kept: after Ctrl-C or a crash "
      "the same\ncommand goes on. Controls are shown as such: they must fail their criterion. "
      "Prints the paths of the\npage and of verdicts.csv, which has every seed's values.\n\n"
      "Examples:\n"
      "  cleave gallery --out out/gallery --jobs 8\n"
      "  cleave gallery --out out/look --coarseness 100 --seeds 1 --layout lattice\n");
  verb->callback([options, &program] {
    program.action = [options](Program& shared) { return GalleryMaker(shared, *options).Make(); };
  });
}

}  // namespace cleave
