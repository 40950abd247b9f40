#ifndef CLEAVE_CLIENT_IO_PLOT_PLOT_H_
#define CLEAVE_CLIENT_IO_PLOT_PLOT_H_

#include <cstdint>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace cleave {

// What a run's plot shows of one frame.
struct PlotSample {
  double time = 0;           // s
  double force = 0;          // N, along the motion
  int64_t broken_edges = 0;  // so far
  int64_t pieces = 0;
};

struct PlotOptions {
  std::string title;                       // UTF-8; may be empty
  std::string force_label = "Pull force";  // names the upper axis
  bool pieces = true;  // adds the pieces as a second curve below, if there are any
};

// The bytes of an SVG picture, 900 x 620 units: force over time above, broken edges and pieces
// below, the first break and the largest force marked. Runs of more than a few thousand frames are
// thinned to the extremes of each interval. Errors: InvalidArgument, naming everything wrong: no
// samples, numbers that are not finite or negative counts, times that do not ascend.
absl::StatusOr<std::string> EncodePlot(std::span<const PlotSample> samples,
                                       const PlotOptions& options);

// Writes the picture aside and renames it to `path`.
absl::Status WritePlot(const std::string& path, std::span<const PlotSample> samples,
                       const PlotOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PLOT_PLOT_H_
