#include "client/io/plot/curve_plot.h"

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

// True stress is drawn where it leaves the nominal one by a share that can be seen.
constexpr double kSeenShare = 0.02;

absl::Status CheckCurves(std::span<const PlottedCurve> curves) {
  std::vector<std::vector<std::span<const double>>> columns;
  for (const PlottedCurve& curve : curves)
    columns.push_back({curve.strain, curve.nominal_stress, curve.true_stress});
  return CheckColumns(columns);
}

std::vector<PlotPoint> PointsOf(const std::vector<double>& strain,
                                const std::vector<double>& stress) {
  std::vector<PlotPoint> points;
  for (size_t k = 0; k < strain.size(); ++k) points.push_back({100 * strain[k], stress[k]});
  return points;
}

bool ShowsTrueStress(const PlottedCurve& curve, double highest) {
  for (size_t k = 0; k < curve.strain.size(); ++k) {
    if (std::abs(curve.true_stress[k] - curve.nominal_stress[k]) > kSeenShare * highest)
      return true;
  }
  return false;
}

}  // namespace

absl::StatusOr<std::string> EncodeCurvePlot(std::span<const PlottedCurve> curves,
                                            const std::string& title, const std::string& subtitle) {
  CLEAVE_RETURN_IF_ERROR(CheckCurves(curves));
  double least_strain = 0, most_strain = 0, least = 0, most = 0;
  for (const PlottedCurve& curve : curves) {
    for (size_t k = 0; k < curve.strain.size(); ++k) {
      least_strain = std::min(least_strain, 100 * curve.strain[k]);
      most_strain = std::max(most_strain, 100 * curve.strain[k]);
      least = std::min({least, curve.nominal_stress[k], curve.true_stress[k]});
      most = std::max({most, curve.nominal_stress[k], curve.true_stress[k]});
    }
  }
  std::vector<LabelledCurve> drawn;
  for (const PlottedCurve& curve : curves) {
    LabelledCurve& line = drawn.emplace_back();
    line.label = curve.label;
    line.points = PointsOf(curve.strain, curve.nominal_stress);
    if (ShowsTrueStress(curve, most - least))
      line.dashed = PointsOf(curve.strain, curve.true_stress);
    line.marked = line.points.back();
    line.crossed = curve.fails;
  }
  const Axis strain = MakeAxis(least_strain, most_strain, 8, false, false);
  const Axis stress = MakeAxis(least, most, 6, true, false);
  return DrawLabelledCurves(
      drawn, strain, stress,
      {title, subtitle, "Strain [%]", absl::StrCat("Stress [", stress.prefix, "Pa]"),
       "true stress, over the area now; lines: nominal stress, over the area at rest"});
}

}  // namespace cleave
