#ifndef CLEAVE_CLIENT_CLI_RUN_PLOT_H_
#define CLEAVE_CLIENT_CLI_RUN_PLOT_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/io/plot/plot.h"
#include "core/scene/scene.h"

namespace cleave {

// What a run's plot shows, from its report lines: the force of the motion that pulls farthest,
// along its way. Lines that are torn are left out. Errors: InvalidArgument when no line is whole.
absl::StatusOr<std::vector<PlotSample>> SamplesOfReports(absl::string_view report_lines,
                                                         const Scene& scene);

// Index of the motion with the longest translation, -1 where none moves, and the unit vector of
// that translation.
struct Pull {
  int64_t motion = -1;
  Vec3 direction{0, 0, 0};
};
Pull FarthestPull(const std::vector<Motion>& motions);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_RUN_PLOT_H_
