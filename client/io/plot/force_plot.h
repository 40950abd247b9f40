#ifndef CLEAVE_CLIENT_IO_PLOT_FORCE_PLOT_H_
#define CLEAVE_CLIENT_IO_PLOT_FORCE_PLOT_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace cleave {

// What a test on a body measured. The columns have one length.
struct ForceCurve {
  std::string label;                 // UTF-8; its line in the legend, before its largest force
  std::vector<double> displacement;  // m, of what is moved, along the pull
  std::vector<double> force;         // N, that moves it
};

// The bytes of an SVG picture, 900 units wide: force over displacement, a colour a curve, the
// largest force of each marked, with a legend below. The title is UTF-8 and may be empty. Errors:
// InvalidArgument, naming everything wrong: no curves, columns of different length or none, numbers
// that are not finite.
absl::StatusOr<std::string> EncodeForcePlot(std::span<const ForceCurve> curves,
                                            const std::string& title);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PLOT_FORCE_PLOT_H_
