#include "client/io/plot/curve_plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "client/io/plot/axis.h"
#include "client/io/plot/drawing.h"
#include "core/base/faults.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr Panel kPanel{82, 498};
constexpr double kLegendTop = kPanel.bottom + 84;
constexpr double kLegendRow = 26;
// Apart for eyes that mix up red and green, and in print. After Okabe and Ito (2008).
constexpr absl::string_view kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                         "#8a6d00", "#56b4e9", "#333333", "#e69f00"};
// True stress is drawn where it leaves the nominal one by a share that can be seen.
constexpr double kSeenShare = 0.02;

absl::Status CheckCurves(std::span<const PlottedCurve> curves) {
  Faults faults;
  if (curves.empty()) faults.Error("curves", "there are none to plot");
  for (size_t i = 0; i < curves.size(); ++i) {
    const std::string field = absl::StrCat("curves[", i, "]");
    const PlottedCurve& curve = curves[i];
    if (curve.strain.empty()) faults.Error(field, "has no points");
    if (curve.nominal_stress.size() != curve.strain.size() ||
        curve.true_stress.size() != curve.strain.size()) {
      faults.Error(field, "has columns of different length");
    }
    for (const auto* column : {&curve.strain, &curve.nominal_stress, &curve.true_stress}) {
      if (std::all_of(column->begin(), column->end(), [](double x) { return std::isfinite(x); }))
        continue;
      faults.Error(field, "has a number that is not finite");
      break;
    }
  }
  return faults.ToStatus();
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
  const Axis strain = MakeAxis(least_strain, most_strain, 8, false, false);
  const Axis stress = MakeAxis(least, most, 6, true, false);
  const bool with_true = std::any_of(curves.begin(), curves.end(), [&](const auto& curve) {
    return ShowsTrueStress(curve, most - least);
  });
  const double rows = static_cast<double>(curves.size()) + (with_true ? 1 : 0);

  Drawing drawing(strain, kLegendTop + kLegendRow * rows);
  if (!title.empty()) {
    drawing.Text(kPlotLeft, 38, "start", " font-size=\"19\" font-weight=\"600\" fill=\"#222\"",
                 EscapedForXml(title));
  }
  if (!subtitle.empty()) {
    drawing.Text(kPlotLeft, 62, "start", " font-size=\"13\" fill=\"#555b63\"",
                 EscapedForXml(subtitle));
  }
  drawing.Frame(kPanel, stress, absl::StrCat("Stress [", stress.prefix, "Pa]"), "#333");
  drawing.HorizontalAxis(kPanel, "Strain [%]");
  for (size_t i = 0; i < curves.size(); ++i) {
    const PlottedCurve& curve = curves[i];
    const absl::string_view color = kColors[i % std::size(kColors)];
    if (ShowsTrueStress(curve, most - least))
      drawing.Curve(kPanel, stress, PointsOf(curve.strain, curve.true_stress), color,
                    CurveStyle::kDashed);
    drawing.Curve(kPanel, stress, PointsOf(curve.strain, curve.nominal_stress), color,
                  CurveStyle::kPlain);
  }
  // On top of all curves, and beside their lines of the legend.
  for (size_t i = 0; i < curves.size(); ++i) {
    const PlottedCurve& curve = curves[i];
    const absl::string_view color = kColors[i % std::size(kColors)];
    const double row = kLegendTop + kLegendRow * static_cast<double>(i);
    const auto mark = [&](double x, double y) {
      if (curve.fails)
        drawing.Cross(x, y, color);
      else
        drawing.Dot(x, y, color);
    };
    mark(drawing.X(100 * curve.strain.back()),
         Drawing::Y(kPanel, stress, curve.nominal_stress.back()));
    drawing.Line(kPlotLeft, row, kPlotLeft + 34, row,
                 absl::StrCat("stroke=\"", color, "\" stroke-width=\"2.2\""));
    mark(kPlotLeft + 34, row);
    drawing.Text(kPlotLeft + 52, row + 5, "start", "", EscapedForXml(curve.label));
  }
  if (with_true) {
    const double row = kLegendTop + kLegendRow * static_cast<double>(curves.size());
    drawing.Line(kPlotLeft, row, kPlotLeft + 34, row,
                 "stroke=\"#555b63\" stroke-width=\"1.6\" stroke-dasharray=\"2 5\" "
                 "stroke-linecap=\"round\"");
    drawing.Text(kPlotLeft + 52, row + 5, "start", " fill=\"#555b63\"",
                 "true stress, over the area now; lines: nominal stress, over the area at rest");
  }
  return drawing.Finish();
}

}  // namespace cleave
