#ifndef CLEAVE_CLIENT_IO_PLOT_CURVE_PLOT_H_
#define CLEAVE_CLIENT_IO_PLOT_CURVE_PLOT_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace cleave {

// A stress-strain curve as a plot shows it. The columns have one length.
struct PlottedCurve {
  std::string label;  // UTF-8; its line in the legend
  std::vector<double> strain;
  std::vector<double> nominal_stress;  // Pa
  std::vector<double> true_stress;     // Pa
  bool fails = false;                  // its last point is a failure
};

// The bytes of an SVG picture, 900 units wide: nominal stress over strain, a colour a curve, true
// stress dotted where it is another, the last point of each marked, with a legend below. Title and
// subtitle are UTF-8 and may be empty. Errors: InvalidArgument, naming everything wrong: no curves,
// columns of different length or none, numbers that are not finite.
absl::StatusOr<std::string> EncodeCurvePlot(std::span<const PlottedCurve> curves,
                                            const std::string& title, const std::string& subtitle);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PLOT_CURVE_PLOT_H_
