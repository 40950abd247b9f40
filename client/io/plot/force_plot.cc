#include "client/io/plot/force_plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/io/plot/axis.h"
#include "client/io/plot/labelled_curves.h"
#include "core/base/status.h"

namespace cleave {
namespace {

absl::Status CheckCurves(std::span<const ForceCurve> curves) {
  std::vector<std::vector<std::span<const double>>> columns;
  for (const ForceCurve& curve : curves) columns.push_back({curve.displacement, curve.force});
  return CheckColumns(columns);
}

}  // namespace

absl::StatusOr<std::string> EncodeForcePlot(std::span<const ForceCurve> curves,
                                            const std::string& title) {
  CLEAVE_RETURN_IF_ERROR(CheckCurves(curves));
  double nearest = 0, farthest = 0, least = 0, most = 0;
  std::vector<LabelledCurve> drawn;
  for (const ForceCurve& curve : curves) {
    LabelledCurve& line = drawn.emplace_back();
    for (size_t k = 0; k < curve.force.size(); ++k) {
      line.points.push_back({curve.displacement[k], curve.force[k]});
      nearest = std::min(nearest, curve.displacement[k]);
      farthest = std::max(farthest, curve.displacement[k]);
      least = std::min(least, curve.force[k]);
      most = std::max(most, curve.force[k]);
    }
    line.marked = *std::max_element(
        line.points.begin(), line.points.end(),
        [](const PlotPoint& a, const PlotPoint& b) { return std::abs(a.y) < std::abs(b.y); });
    line.label = absl::StrCat(curve.label, ": ", WithPrefix(line.marked.y, "N"), " at ",
                              WithPrefix(line.marked.x, "m"));
  }
  const Axis displacement = MakeAxis(nearest, farthest, 8, true, false);
  const Axis force = MakeAxis(least, most, 6, true, false);
  return DrawLabelledCurves(drawn, displacement, force,
                            {title, "", absl::StrCat("Displacement [", displacement.prefix, "m]"),
                             absl::StrCat("Force [", force.prefix, "N]")});
}

}  // namespace cleave
