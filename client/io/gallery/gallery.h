#ifndef CLEAVE_CLIENT_IO_GALLERY_GALLERY_H_
#define CLEAVE_CLIENT_IO_GALLERY_GALLERY_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

// What `cleave gallery` shows: demonstrations, their pictures, what was measured, and verdicts.
// Scenes and findings are what the scene runner tells of them.

namespace cleave {

// A measured value with its bound.
struct GalleryCondition {
  std::string text;
  std::string bound;           // "at least 3"
  std::vector<double> values;  // a trial each; not a number: it was not measured
};

// A criterion over the trials of one layout.
struct GalleryFinding {
  std::string text;
  bool control = false;  // must not be met
  bool asked = true;     // false: of bodies of full size, and these are coarse
  bool holds = false;    // met, or of a control, not met
  int64_t met = 0, unmeasured = 0, trials = 0, needed = 0;
  std::vector<GalleryCondition> conditions;
};

struct GalleryGroup {
  std::string layout;
  double coarseness = 1;
  std::vector<int64_t> seeds;
  std::vector<GalleryFinding> findings;
};

struct GalleryPicture {
  std::string variant;
  std::string png;  // the file's bytes
  bool control = false;
};

struct GalleryScene {
  std::string name, title, paper;
  std::vector<std::string> variants;  // that criteria are about
  std::vector<std::string> controls;  // of these, those that only controls are about
  std::vector<std::string> pictured;  // of these; empty: all
  double coarsest = 1;                // the largest coarseness that its body takes
  std::vector<GalleryPicture> pictures = {};
  std::vector<GalleryGroup> groups = {};
  std::vector<std::string> failures = {};  // runs that ended with an error, a line each
  int64_t runs = 0, runs_done = 0;
};

struct Gallery {
  std::string build;     // of the scene runner
  std::string settings;  // a line
  std::vector<GalleryScene> scenes;
};

// How a finding is told.
enum class Verdict { kMet, kNotMet, kNotAsked, kNotRun };
Verdict VerdictOf(const GalleryFinding& finding);
// "met"; of a control "fails, as it should", "passes: no evidence" ...
absl::string_view VerdictText(const GalleryFinding& finding);

struct VerdictCount {
  int64_t good = 0;  // as they should be
  int64_t all = 0;   // of those asked that were run
};
VerdictCount CountVerdicts(const Gallery& gallery);

// The scene runner's list, and its findings of one scene. Errors: InvalidArgument, naming the
// member that is missing or of another kind.
absl::StatusOr<std::vector<GalleryScene>> ParseSceneList(const std::string& json);
absl::StatusOr<std::vector<GalleryGroup>> ParseFindings(const std::string& json);

// A page of HTML that needs no other file. The same gallery gives the same bytes.
std::string GalleryPage(const Gallery& gallery);

// The same as a table, comma-separated with a line of headings (RFC 4180): a row for each condition
// of each criterion and layout. Seeds and their values are separated by spaces, "nan" where a value
// was not measured; `met` counts the seeds that meet all conditions of the criterion.
std::string VerdictTable(const Gallery& gallery);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_GALLERY_GALLERY_H_
