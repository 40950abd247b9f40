#ifndef CLEAVE_CLIENT_CLI_GALLERY_RUNS_H_
#define CLEAVE_CLIENT_CLI_GALLERY_RUNS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/io/gallery/gallery.h"

namespace cleave {

// One run of the scene runner.
struct GalleryRun {
  std::string scene, variant, layout;  // layout: "lattice" or "unstructured"
  uint32_t seed = 1;
  double coarseness = 1;
  bool pictured = false;
};

// Every variant of every scene, seed and layout; pictures are of the first seed and layout.
std::vector<GalleryRun> RunsOf(const std::vector<GalleryScene>& scenes,
                               const std::vector<uint32_t>& seeds,
                               const std::vector<std::string>& layouts, double coarseness);

// "3" or "2-6" or "1,4-6": seeds in the order given. InvalidArgument for other text, for a seed
// twice, or more than 1000.
absl::StatusOr<std::vector<uint32_t>> ParseSeeds(absl::string_view text);

// The program beside `cleave`, in the tree that it was built in, or installed with it. NotFound.
absl::StatusOr<std::string> FindSceneRunner();
// Tells programs apart: the start of its SHA-256. Errors of reading the file.
absl::StatusOr<std::string> BuildOf(const std::string& program);

// What a gallery's folder keeps of runs: a line of JSON each and pictures. What another build of
// the runner, or another width of pictures, left there counts as not there.
class GalleryFolder {
 public:
  GalleryFolder(std::string path, absl::string_view build, int width);

  absl::Status Make() const;
  absl::Status Clear() const;  // removes runs and pictures
  std::string page() const { return path_ + "/index.html"; }
  std::string table() const { return path_ + "/verdicts.csv"; }
  std::string PicturePath(const GalleryRun& run) const;
  // Empty: there is none.
  std::string Find(const GalleryRun& run) const;
  absl::Status Keep(const GalleryRun& run, absl::string_view line) const;

 private:
  std::string RecordPath(const GalleryRun& run) const;

  std::string path_;
  std::string head_;  // the first line of records
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_GALLERY_RUNS_H_
