#include "client/io/plot/plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "client/io/plot/axis.h"
#include "client/io/plot/drawing.h"
#include "client/io/series/write_aside.h"
#include "core/base/faults.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr absl::string_view kForceColor = "#b5532f";
constexpr absl::string_view kBrokenColor = "#2c5f8a";
constexpr absl::string_view kPiecesColor = "#4d8050";
constexpr Panel kUpper{64, 330};
constexpr Panel kLower{372, 560};

absl::Status CheckSamples(std::span<const PlotSample> samples) {
  Faults faults;
  if (samples.empty()) faults.Error("samples", "there are none to plot");
  for (size_t i = 0; i < samples.size(); ++i) {
    const std::string field = absl::StrCat("samples[", i, "]");
    if (!std::isfinite(samples[i].time) || !std::isfinite(samples[i].force)) {
      faults.Error(field, "time or force is not finite");
    } else if (i > 0 && !(samples[i].time >= samples[i - 1].time)) {
      faults.Error(field, absl::StrCat("time ", samples[i].time, " s is before ",
                                       samples[i - 1].time, " s"));
    }
    if (samples[i].broken_edges < 0 || samples[i].pieces < 0) {
      faults.Error(field, "a count is negative");
    }
  }
  return faults.ToStatus();
}

// "12.3 N", with three digits and a prefix.
std::string WithUnit(double value, absl::string_view unit) {
  const Axis axis = MakeAxis(std::min(value, 0.0), std::max(value, 0.0), 4, true, false);
  double scale = 1;
  for (const auto& [name, factor] : {std::pair<absl::string_view, double>{"G", 1e9},
                                     {"M", 1e6},
                                     {"k", 1e3},
                                     {"m", 1e-3},
                                     {"µ", 1e-6},
                                     {"n", 1e-9}}) {
    if (axis.prefix == name) scale = factor;
  }
  return absl::StrFormat("%.3g %s%s", value / scale, axis.prefix, unit);
}

// Marks the largest force and, through both panels, the first break.
void AddMarks(std::span<const PlotSample> samples, const Axis& force, Drawing& drawing) {
  const auto broken = std::find_if(samples.begin(), samples.end(),
                                   [](const PlotSample& s) { return s.broken_edges > 0; });
  if (broken != samples.end()) {
    const double x = drawing.X(broken->time);
    drawing.Line(x, kUpper.top, x, kLower.bottom, "stroke=\"#6b7078\" stroke-dasharray=\"5 4\"");
    const bool room = x < kPlotRight - 190;
    drawing.Text(room ? x + 7 : x - 7, (kUpper.bottom + kLower.top) / 2 + 5, room ? "start" : "end",
                 " font-size=\"13\" fill=\"#555b63\"",
                 absl::StrCat("first break, ", WithUnit(broken->time, "s")));
  }
  const auto peak = std::max_element(samples.begin(), samples.end(),
                                     [](const PlotSample& a, const PlotSample& b) {
                                       return std::abs(a.force) < std::abs(b.force);
                                     });
  if (peak->force == 0) return;
  const double x = drawing.X(peak->time);
  const double y = Drawing::Y(kUpper, force, peak->force);
  drawing.Dot(x, y, kForceColor);
  const bool room = x < kPlotRight - 190;
  drawing.Text(room ? x + 10 : x - 10, peak->force > 0 ? y - 6 : y + 18, room ? "start" : "end",
               " font-size=\"13\" font-weight=\"600\"",
               absl::StrCat("peak ", WithUnit(peak->force, "N")));
}

}  // namespace

absl::StatusOr<std::string> EncodePlot(std::span<const PlotSample> samples,
                                       const PlotOptions& options) {
  CLEAVE_RETURN_IF_ERROR(CheckSamples(samples));
  double least = 0;
  double most = 0;
  int64_t pieces = 0;
  for (const PlotSample& sample : samples) {
    least = std::min(least, sample.force);
    most = std::max(most, sample.force);
    pieces = std::max(pieces, sample.pieces);
  }
  // Counts never fall below what they were; the last is the largest.
  const auto broken = static_cast<double>(samples.back().broken_edges);
  const Axis time = MakeAxis(samples.front().time, samples.back().time, 8, true, false);
  const double room = 0.06 * (most - least);  // for the label of the largest force
  const Axis force = MakeAxis(least, most + (most > 0 ? room : 0), 5, true, false);
  const Axis edges = MakeAxis(0, broken, 4, false, true);
  const bool with_pieces = options.pieces && pieces > 0;

  Drawing drawing(samples, time);
  if (!options.title.empty()) {
    drawing.Text(kPlotLeft, 38, "start", " font-size=\"19\" font-weight=\"600\" fill=\"#222\"",
                 EscapedForXml(options.title));
  }
  drawing.Frame(kUpper, force,
                absl::StrCat(EscapedForXml(options.force_label), " [", force.prefix, "N]"),
                kForceColor);
  drawing.Frame(kLower, edges, "Broken edges", kBrokenColor);
  drawing.TimeAxis(kLower);
  drawing.Curve(
      kUpper, force, [](const PlotSample& s) { return s.force; }, kForceColor, false, true);
  drawing.Curve(
      kLower, edges, [](const PlotSample& s) { return static_cast<double>(s.broken_edges); },
      kBrokenColor, true, true);
  if (with_pieces) {
    const Axis count = MakeAxis(0, static_cast<double>(pieces), 4, false, true);
    drawing.RightAxis(kLower, count, "Pieces", kPiecesColor);
    drawing.Curve(
        kLower, count, [](const PlotSample& s) { return static_cast<double>(s.pieces); },
        kPiecesColor, true, false);
  }
  AddMarks(samples, force, drawing);
  return drawing.Finish();
}

absl::Status WritePlot(const std::string& path, std::span<const PlotSample> samples,
                       const PlotOptions& options) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, EncodePlot(samples, options));
  return WriteAside(path, bytes);
}

}  // namespace cleave
