#ifndef CLEAVE_TESTS_SCENES_SCENE_JSON_H_
#define CLEAVE_TESTS_SCENES_SCENE_JSON_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "tests/scenes/demonstration.h"

// What the scene runner prints and reads, a line of JSON each; `cleave gallery` talks to it by
// these.

namespace cleave {

absl::string_view LayoutName(MeshLayout layout);  // "lattice", "unstructured"

// {"scene", "variant", "seed", "layout", "coarseness", a member a metric}; null: not a number.
std::string RunJson(const std::string& name, const Setting& setting, const Metrics& metrics);

// {"scenes": [{"name", "title", "paper", "variants", "pictured", "criteria": [{"text", "control",
// "full_size", "share", "variants", "conditions": [{"text", "bound"}]}]}]}
std::string KindsJson();

// Trials of lines of RunJson, in the order of their first lines; a line that has "error" in place
// of metrics is of a run that failed, which meets nothing. InvalidArgument, naming the line, for
// what is no such line or of another scene.
absl::StatusOr<std::vector<Trial>> ReadTrials(const DemonstrationKind& kind,
                                              absl::string_view lines);

// {"scene", "groups": [{"layout", "coarseness", "seeds", "findings": [{"text", "control", "asked",
// "holds", "met", "unmeasured", "trials", "needed", "conditions": [{"text", "bound",
// "values"}]}]}]}: trials of one layout and coarseness are judged together, by those that have all
// variants of a criterion. asked: false of full-size criteria and coarse bodies.
std::string FindingsJson(const DemonstrationKind& kind, const std::vector<Trial>& trials);

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_SCENE_JSON_H_
