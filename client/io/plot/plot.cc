#include "client/io/plot/plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

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

using Value = std::function<double(const PlotSample&)>;

constexpr size_t kMostPoints = 2000;

// Positions of the samples to draw: all, or of each interval the first and those where a value is
// smallest and largest.
std::vector<size_t> Thinned(std::span<const PlotSample> samples, const Value& value) {
  std::vector<size_t> kept;
  if (samples.size() <= kMostPoints) {
    for (size_t i = 0; i < samples.size(); ++i) kept.push_back(i);
    return kept;
  }
  const size_t intervals = kMostPoints / 3;
  for (size_t interval = 0; interval < intervals; ++interval) {
    const size_t begin = interval * samples.size() / intervals;
    const size_t end = (interval + 1) * samples.size() / intervals;
    size_t least = begin;
    size_t most = begin;
    for (size_t i = begin; i < end; ++i) {
      if (value(samples[i]) < value(samples[least])) least = i;
      if (value(samples[i]) > value(samples[most])) most = i;
    }
    for (const size_t i : {begin, std::min(least, most), std::max(least, most)}) {
      if (kept.empty() || kept.back() != i) kept.push_back(i);
    }
  }
  if (kept.back() != samples.size() - 1) kept.push_back(samples.size() - 1);
  return kept;
}

std::vector<PlotPoint> PointsOf(std::span<const PlotSample> samples, const Value& value) {
  std::vector<PlotPoint> points;
  for (const size_t i : Thinned(samples, value))
    points.push_back({samples[i].time, value(samples[i])});
  return points;
}

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
                 absl::StrCat("first break, ", WithPrefix(broken->time, "s")));
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
               absl::StrCat("peak ", WithPrefix(peak->force, "N")));
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

  Drawing drawing(time);
  if (!options.title.empty()) {
    drawing.Text(kPlotLeft, 38, "start", " font-size=\"19\" font-weight=\"600\" fill=\"#222\"",
                 EscapedForXml(options.title));
  }
  drawing.Frame(kUpper, force,
                absl::StrCat(EscapedForXml(options.force_label), " [", force.prefix, "N]"),
                kForceColor);
  drawing.Frame(kLower, edges, "Broken edges", kBrokenColor);
  drawing.HorizontalAxis(kLower, absl::StrCat("Time [", time.prefix, "s]"));
  drawing.Curve(kUpper, force, PointsOf(samples, [](const PlotSample& s) { return s.force; }),
                kForceColor, CurveStyle::kFilled);
  drawing.Curve(
      kLower, edges,
      PointsOf(samples, [](const PlotSample& s) { return static_cast<double>(s.broken_edges); }),
      kBrokenColor, CurveStyle::kFilledSteps);
  if (with_pieces) {
    const Axis count = MakeAxis(0, static_cast<double>(pieces), 4, false, true);
    drawing.RightAxis(kLower, count, "Pieces", kPiecesColor);
    drawing.Curve(
        kLower, count,
        PointsOf(samples, [](const PlotSample& s) { return static_cast<double>(s.pieces); }),
        kPiecesColor, CurveStyle::kSteps);
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
