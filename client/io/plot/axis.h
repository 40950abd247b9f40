#ifndef CLEAVE_CLIENT_IO_PLOT_AXIS_H_
#define CLEAVE_CLIENT_IO_PLOT_AXIS_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace cleave {

// A scale with round numbers on it, and the factor by which values are written.
struct Axis {
  double low = 0;
  double high = 1;
  std::vector<double> ticks;        // ascending, first at `low`, last at `high`
  std::vector<std::string> labels;  // a tick each, in prefixed units
  std::string prefix;               // of the unit: "k", "m", "" ...
};

// A scale over [low, high] whose ends and about `wanted` steps are multiples of 1, 2 or 5 times a
// power of ten. Equal ends are moved apart. `prefixed` chooses an SI prefix so that labels stay
// short; `whole` keeps steps at 1 or more, for counts. Precondition: finite, low <= high.
Axis MakeAxis(double low, double high, int wanted, bool prefixed, bool whole);

// "12.3 kN" for a value in a unit: three digits and an SI prefix.
std::string WithPrefix(double value, absl::string_view unit);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PLOT_AXIS_H_
