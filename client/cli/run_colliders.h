#ifndef CLEAVE_CLIENT_CLI_RUN_COLLIDERS_H_
#define CLEAVE_CLIENT_CLI_RUN_COLLIDERS_H_

#include <cstdint>
#include <map>
#include <vector>

#include "absl/strings/string_view.h"
#include "client/io/preview/props.h"
#include "core/scene/scene.h"

namespace cleave {

// Where each of a scene's colliders was after each frame, by the run's reports; the last line of a
// frame counts. Torn and foreign lines are left out, and so are colliders that a line lacks.
std::vector<std::map<int64_t, PropPlace>> ColliderPlacesOfReports(absl::string_view report_lines);

// The colliders of a scene that pictures show, in their places by the reports.
std::vector<Prop> PropsOfRun(const Scene& scene, absl::string_view report_lines);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_RUN_COLLIDERS_H_
