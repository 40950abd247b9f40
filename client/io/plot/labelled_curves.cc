#include "client/io/plot/labelled_curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/base/faults.h"

namespace cleave {
namespace {

constexpr Panel kPanel{82, 498};
constexpr double kLegendTop = kPanel.bottom + 84;
constexpr double kLegendRow = 26;
// Apart for eyes that mix up red and green, and in print. After Okabe and Ito (2008).
constexpr absl::string_view kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                         "#8a6d00", "#56b4e9", "#333333", "#e69f00"};

void Mark(Drawing& drawing, const LabelledCurve& curve, double x, double y,
          absl::string_view color) {
  if (curve.crossed)
    drawing.Cross(x, y, color);
  else
    drawing.Dot(x, y, color);
}

}  // namespace

absl::Status CheckColumns(std::span<const std::vector<std::span<const double>>> curves) {
  Faults faults;
  if (curves.empty()) faults.Error("curves", "there are none to plot");
  for (size_t i = 0; i < curves.size(); ++i) {
    const std::string field = absl::StrCat("curves[", i, "]");
    const size_t length = curves[i].front().size();
    if (length == 0) faults.Error(field, "has no points");
    bool equal = true, finite = true;
    for (const std::span<const double> column : curves[i]) {
      equal = equal && column.size() == length;
      finite = finite &&
               std::all_of(column.begin(), column.end(), [](double x) { return std::isfinite(x); });
    }
    if (!equal) faults.Error(field, "has columns of different length");
    if (!finite) faults.Error(field, "has a number that is not finite");
  }
  return faults.ToStatus();
}

std::string DrawLabelledCurves(std::span<const LabelledCurve> curves, const Axis& horizontal,
                               const Axis& vertical, const CurveTitles& titles) {
  const bool any_dashed = std::any_of(curves.begin(), curves.end(),
                                      [](const auto& curve) { return !curve.dashed.empty(); });
  const double rows = static_cast<double>(curves.size()) + (any_dashed ? 1 : 0);
  Drawing drawing(horizontal, kLegendTop + kLegendRow * rows);
  if (!titles.title.empty()) {
    drawing.Text(kPlotLeft, 38, "start", " font-size=\"19\" font-weight=\"600\" fill=\"#222\"",
                 EscapedForXml(titles.title));
  }
  if (!titles.subtitle.empty()) {
    drawing.Text(kPlotLeft, 62, "start", " font-size=\"13\" fill=\"#555b63\"",
                 EscapedForXml(titles.subtitle));
  }
  drawing.Frame(kPanel, vertical, titles.vertical, "#333");
  drawing.HorizontalAxis(kPanel, titles.horizontal);
  for (size_t i = 0; i < curves.size(); ++i) {
    const absl::string_view color = kColors[i % std::size(kColors)];
    if (!curves[i].dashed.empty())
      drawing.Curve(kPanel, vertical, curves[i].dashed, color, CurveStyle::kDashed);
    drawing.Curve(kPanel, vertical, curves[i].points, color, CurveStyle::kPlain);
  }
  // On top of all curves, and beside their lines of the legend.
  for (size_t i = 0; i < curves.size(); ++i) {
    const LabelledCurve& curve = curves[i];
    const absl::string_view color = kColors[i % std::size(kColors)];
    const double row = kLegendTop + kLegendRow * static_cast<double>(i);
    Mark(drawing, curve, drawing.X(curve.marked.x), Drawing::Y(kPanel, vertical, curve.marked.y),
         color);
    drawing.Line(kPlotLeft, row, kPlotLeft + 34, row,
                 absl::StrCat("stroke=\"", color, "\" stroke-width=\"2.2\""));
    Mark(drawing, curve, kPlotLeft + 34, row, color);
    drawing.Text(kPlotLeft + 52, row + 5, "start", "", EscapedForXml(curve.label));
  }
  if (any_dashed) {
    const double row = kLegendTop + kLegendRow * static_cast<double>(curves.size());
    drawing.Line(kPlotLeft, row, kPlotLeft + 34, row,
                 "stroke=\"#555b63\" stroke-width=\"1.6\" stroke-dasharray=\"2 5\" "
                 "stroke-linecap=\"round\"");
    drawing.Text(kPlotLeft + 52, row + 5, "start", " fill=\"#555b63\"",
                 EscapedForXml(titles.dashed));
  }
  return drawing.Finish();
}

}  // namespace cleave
