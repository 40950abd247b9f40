#include "client/cli/gallery_runs.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/series/write_aside.h"
#include "core/base/sha256.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr size_t kMostSeeds = 1000;

// What tells a run from others, as part of a file's name.
std::string NameOf(const GalleryRun& run) {
  return absl::StrCat(run.scene, "-", run.variant, "-", run.layout, "-seed", run.seed, "-x",
                      run.coarseness);
}

}  // namespace

std::vector<GalleryRun> RunsOf(const std::vector<GalleryScene>& scenes,
                               const std::vector<uint32_t>& seeds,
                               const std::vector<std::string>& layouts, double coarseness) {
  std::vector<GalleryRun> runs;
  for (const GalleryScene& scene : scenes) {
    for (const std::string& layout : layouts) {
      for (const uint32_t seed : seeds) {
        for (const std::string& variant : scene.variants) {
          const bool shown = scene.pictured.empty() ||
                             std::find(scene.pictured.begin(), scene.pictured.end(), variant) !=
                                 scene.pictured.end();
          runs.push_back({scene.name, variant, layout, seed, std::min(coarseness, scene.coarsest),
                          shown && seed == seeds.front() && layout == layouts.front()});
        }
      }
    }
  }
  return runs;
}

absl::StatusOr<std::vector<uint32_t>> ParseSeeds(absl::string_view text) {
  std::vector<uint32_t> seeds;
  for (const absl::string_view part : absl::StrSplit(text, ',')) {
    const std::pair<absl::string_view, absl::string_view> ends =
        absl::StrSplit(part, absl::MaxSplits('-', 1));
    uint32_t first = 0, last = 0;
    const bool range = part.find('-') != absl::string_view::npos;
    if (!absl::SimpleAtoi(ends.first, &first) ||
        !absl::SimpleAtoi(range ? ends.second : ends.first, &last) || last < first) {
      return absl::InvalidArgumentError(
          absl::StrCat("--seeds: \"", text, "\" is not like 2-6 or 1,4,7"));
    }
    if (last - first >= kMostSeeds || seeds.size() + (last - first) >= kMostSeeds)
      return absl::InvalidArgumentError(absl::StrCat("--seeds: more than ", kMostSeeds));
    for (uint32_t i = 0; i <= last - first; ++i) {
      if (std::find(seeds.begin(), seeds.end(), first + i) != seeds.end())
        return absl::InvalidArgumentError(absl::StrCat("--seeds: ", first + i, " is there twice"));
      seeds.push_back(first + i);
    }
  }
  return seeds;
}

absl::StatusOr<std::string> FindSceneRunner() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path folder = self.parent_path();
  for (const char* place :
       {"scene_runner", "../../tests/scenes/scene_runner", "../libexec/cleave/scene_runner"}) {
    const std::filesystem::path path = folder / place;
    if (access(path.c_str(), X_OK) == 0 && !std::filesystem::is_directory(path, error))
      return path.lexically_normal().string();
  }
  return absl::NotFoundError(
      absl::StrCat("the program scene_runner, which has the scenes, is neither beside ",
                   self.string(), " nor in ../libexec/cleave; name it with --runner"));
}

absl::StatusOr<std::string> BuildOf(const std::string& program) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(program));
  return absl::BytesToHexString(Sha256::Of(bytes)).substr(0, 16);
}

GalleryFolder::GalleryFolder(std::string path, absl::string_view build, int width)
    : path_(std::move(path)),
      head_(absl::StrCat("{\"build\":\"", build, "\",\"width\":", width, "}\n")) {}

std::string GalleryFolder::RecordPath(const GalleryRun& run) const {
  return absl::StrCat(path_, "/runs/", NameOf(run), ".jsonl");
}

std::string GalleryFolder::PicturePath(const GalleryRun& run) const {
  return absl::StrCat(path_, "/pictures/", NameOf(run), ".png");
}

absl::Status GalleryFolder::Make() const {
  CLEAVE_RETURN_IF_ERROR(MakeDirectories(path_ + "/runs"));
  return MakeDirectories(path_ + "/pictures");
}

absl::Status GalleryFolder::Clear() const {
  for (const char* part : {"/runs", "/pictures"}) {
    std::error_code error;
    std::filesystem::remove_all(path_ + part, error);
    if (error) return absl::InternalError(absl::StrCat(path_, part, ": ", error.message()));
  }
  return absl::OkStatus();
}

std::string GalleryFolder::Find(const GalleryRun& run) const {
  const std::string path = RecordPath(run);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return "";
  if (run.pictured && !std::filesystem::exists(PicturePath(run), error)) return "";
  const absl::StatusOr<std::string> record = ReadFileBytes(path);
  if (!record.ok() || record->rfind(head_, 0) != 0) return "";
  return record->substr(head_.size());
}

absl::Status GalleryFolder::Keep(const GalleryRun& run, absl::string_view line) const {
  // A picture that stands already is another build's.
  std::error_code error;
  if (!run.pictured) std::filesystem::remove(PicturePath(run), error);
  return WriteAside(RecordPath(run), absl::StrCat(head_, line));
}

}  // namespace cleave
