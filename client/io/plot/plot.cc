#include "client/io/plot/plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "client/io/plot/axis.h"
#include "client/io/series/write_aside.h"
#include "core/base/faults.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr double kWidth = 900;
constexpr double kHeight = 620;
constexpr double kLeft = 88;
constexpr double kRight = kWidth - 84;
constexpr absl::string_view kForceColor = "#b5532f";
constexpr absl::string_view kBrokenColor = "#2c5f8a";
constexpr absl::string_view kPiecesColor = "#4d8050";
constexpr size_t kMostPoints = 2000;

struct Panel {
  double top;
  double bottom;
};
constexpr Panel kUpper{64, 330};
constexpr Panel kLower{372, 560};

using Value = std::function<double(const PlotSample&)>;

std::string Escaped(absl::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        // Control characters are no XML.
        if (static_cast<unsigned char>(c) >= 32) out += c;
    }
  }
  return out;
}

double Place(const Axis& axis, double value, double from, double to) {
  return from + (value - axis.low) / (axis.high - axis.low) * (to - from);
}

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

class Drawing {
 public:
  Drawing(std::span<const PlotSample> samples, const Axis& time) : samples_(samples), time_(time) {
    absl::StrAppendFormat(
        &svg_,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" "
        "height=\"%g\" font-family=\"'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', "
        "sans-serif\" font-size=\"14\" fill=\"#333\">\n"
        "<rect width=\"%g\" height=\"%g\" fill=\"#ffffff\"/>\n",
        kWidth, kHeight, kWidth, kHeight, kWidth, kHeight);
  }

  void Text(double x, double y, absl::string_view anchor, absl::string_view attributes,
            absl::string_view text) {
    absl::StrAppendFormat(&svg_, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>%s</text>\n", x,
                          y, anchor, attributes, text);
  }
  void Line(double x1, double y1, double x2, double y2, absl::string_view style) {
    absl::StrAppendFormat(&svg_, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x1,
                          y1, x2, y2, style);
  }

  double X(double time) const { return Place(time_, time, kLeft, kRight); }
  static double Y(const Panel& panel, const Axis& axis, double value) {
    return Place(axis, value, panel.bottom, panel.top);
  }

  // Grid, ticks and title of a panel's left axis, and the time grid.
  void Frame(const Panel& panel, const Axis& axis, absl::string_view title,
             absl::string_view color) {
    absl::StrAppendFormat(&svg_,
                          "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"#f7f8fa\"/>\n",
                          kLeft, panel.top, kRight - kLeft, panel.bottom - panel.top);
    for (const double tick : time_.ticks) {
      Line(X(tick), panel.top, X(tick), panel.bottom, "stroke=\"#e1e4e9\"");
    }
    for (size_t i = 0; i < axis.ticks.size(); ++i) {
      const double y = Y(panel, axis, axis.ticks[i]);
      const bool zero = std::abs(axis.ticks[i]) < 1e-9 * (axis.high - axis.low);
      Line(kLeft, y, kRight, y, zero ? "stroke=\"#9aa0a8\"" : "stroke=\"#e1e4e9\"");
      Text(kLeft - 9, y + 5, "end", "", axis.labels[i]);
    }
    SideTitle(24, panel, title, color);
  }

  void RightAxis(const Panel& panel, const Axis& axis, absl::string_view title,
                 absl::string_view color) {
    for (size_t i = 0; i < axis.ticks.size(); ++i) {
      const double y = Y(panel, axis, axis.ticks[i]);
      Line(kRight, y, kRight + 5, y, "stroke=\"#9aa0a8\"");
      Text(kRight + 10, y + 5, "start", "", axis.labels[i]);
    }
    SideTitle(kWidth - 18, panel, title, color);
  }

  void TimeAxis(const Panel& panel) {
    for (size_t i = 0; i < time_.ticks.size(); ++i) {
      Text(X(time_.ticks[i]), panel.bottom + 22, "middle", "", time_.labels[i]);
    }
    Text((kLeft + kRight) / 2, panel.bottom + 46, "middle", "",
         absl::StrCat("Time [", time_.prefix, "s]"));
  }

  // A curve; counts hold their value until the next sample (`steps`) and may be filled below.
  void Curve(const Panel& panel, const Axis& axis, const Value& value, absl::string_view color,
             bool steps, bool filled) {
    std::string path;
    double last_y = 0;
    double last_x = 0;
    double first_x = 0;
    for (const size_t i : Thinned(samples_, value)) {
      const double x = X(samples_[i].time);
      const double y = Y(panel, axis, value(samples_[i]));
      if (path.empty()) {
        absl::StrAppendFormat(&path, "M%.2f %.2f", x, y);
        first_x = x;
      } else {
        if (steps && y != last_y) absl::StrAppendFormat(&path, "L%.2f %.2f", x, last_y);
        absl::StrAppendFormat(&path, "L%.2f %.2f", x, y);
      }
      last_x = x;
      last_y = y;
    }
    if (filled) {
      const double base = Y(panel, axis, std::max(axis.low, 0.0));
      absl::StrAppendFormat(
          &svg_, "<path d=\"%sL%.2f %.2fL%.2f %.2fZ\" fill=\"%s\" fill-opacity=\"0.13\"/>\n", path,
          last_x, base, first_x, base, color);
    }
    absl::StrAppendFormat(&svg_,
                          "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2.2\" "
                          "stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n",
                          path, color);
  }

  void Dot(double x, double y, absl::string_view color) {
    absl::StrAppendFormat(
        &svg_,
        "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"%s\" stroke=\"#ffffff\" "
        "stroke-width=\"1.5\"/>\n",
        x, y, color);
  }

  std::string Finish() { return absl::StrCat(svg_, "</svg>\n"); }

 private:
  void SideTitle(double x, const Panel& panel, absl::string_view title, absl::string_view color) {
    const double y = (panel.top + panel.bottom) / 2;
    Text(x, y, "middle",
         absl::StrFormat(" transform=\"rotate(-90 %.1f %.1f)\" fill=\"%s\"", x, y, color), title);
  }

  std::span<const PlotSample> samples_;
  const Axis& time_;
  std::string svg_;
};

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
    const bool room = x < kRight - 190;
    drawing.Text(room ? x + 7 : x - 7, kLower.top + 18, room ? "start" : "end",
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
  const bool room = x < kRight - 190;
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
  Axis time = MakeAxis(samples.front().time, samples.back().time, 8, true, false);
  const double room = 0.06 * (most - least);  // for the label of the largest force
  const Axis force = MakeAxis(least, most + (most > 0 ? room : 0), 5, true, false);
  const Axis edges = MakeAxis(0, broken, 4, false, true);
  const bool with_pieces = options.pieces && pieces > 0;

  Drawing drawing(samples, time);
  if (!options.title.empty()) {
    drawing.Text(kLeft, 38, "start", " font-size=\"19\" font-weight=\"600\" fill=\"#222\"",
                 Escaped(options.title));
  }
  drawing.Frame(kUpper, force, absl::StrCat(Escaped(options.force_label), " [", force.prefix, "N]"),
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
