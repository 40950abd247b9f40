#include "client/io/plot/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cleave {
namespace {

constexpr size_t kMostPoints = 2000;

double Place(const Axis& axis, double value, double from, double to) {
  return from + (value - axis.low) / (axis.high - axis.low) * (to - from);
}

// Positions of the samples to draw: all, or of each interval the first and those where a value is
// smallest and largest.
std::vector<size_t> Thinned(std::span<const PlotSample> samples, const Drawing::Value& value) {
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

}  // namespace

std::string EscapedForXml(absl::string_view text) {
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

Drawing::Drawing(std::span<const PlotSample> samples, const Axis& time)
    : samples_(samples), time_(time) {
  absl::StrAppendFormat(
      &svg_,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" "
      "height=\"%g\" font-family=\"'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', "
      "sans-serif\" font-size=\"14\" fill=\"#333\">\n"
      "<rect width=\"%g\" height=\"%g\" fill=\"#ffffff\"/>\n",
      kPlotWidth, kPlotHeight, kPlotWidth, kPlotHeight, kPlotWidth, kPlotHeight);
}

void Drawing::Text(double x, double y, absl::string_view anchor, absl::string_view attributes,
                   absl::string_view text) {
  absl::StrAppendFormat(&svg_, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>%s</text>\n", x, y,
                        anchor, attributes, text);
}
void Drawing::Line(double x1, double y1, double x2, double y2, absl::string_view style) {
  absl::StrAppendFormat(&svg_, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x1,
                        y1, x2, y2, style);
}

double Drawing::X(double time) const { return Place(time_, time, kPlotLeft, kPlotRight); }
double Drawing::Y(const Panel& panel, const Axis& axis, double value) {
  return Place(axis, value, panel.bottom, panel.top);
}

void Drawing::Frame(const Panel& panel, const Axis& axis, absl::string_view title,
                    absl::string_view color) {
  absl::StrAppendFormat(&svg_,
                        "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"#f7f8fa\"/>\n",
                        kPlotLeft, panel.top, kPlotRight - kPlotLeft, panel.bottom - panel.top);
  for (const double tick : time_.ticks) {
    Line(X(tick), panel.top, X(tick), panel.bottom, "stroke=\"#e1e4e9\"");
  }
  for (size_t i = 0; i < axis.ticks.size(); ++i) {
    const double y = Y(panel, axis, axis.ticks[i]);
    const bool zero = std::abs(axis.ticks[i]) < 1e-9 * (axis.high - axis.low);
    Line(kPlotLeft, y, kPlotRight, y, zero ? "stroke=\"#9aa0a8\"" : "stroke=\"#e1e4e9\"");
    Text(kPlotLeft - 9, y + 5, "end", "", axis.labels[i]);
  }
  SideTitle(24, panel, title, color);
}

void Drawing::RightAxis(const Panel& panel, const Axis& axis, absl::string_view title,
                        absl::string_view color) {
  for (size_t i = 0; i < axis.ticks.size(); ++i) {
    const double y = Y(panel, axis, axis.ticks[i]);
    Line(kPlotRight, y, kPlotRight + 5, y, "stroke=\"#9aa0a8\"");
    Text(kPlotRight + 10, y + 5, "start", "", axis.labels[i]);
  }
  SideTitle(kPlotWidth - 18, panel, title, color);
}

void Drawing::TimeAxis(const Panel& panel) {
  for (size_t i = 0; i < time_.ticks.size(); ++i) {
    Text(X(time_.ticks[i]), panel.bottom + 22, "middle", "", time_.labels[i]);
  }
  Text((kPlotLeft + kPlotRight) / 2, panel.bottom + 46, "middle", "",
       absl::StrCat("Time [", time_.prefix, "s]"));
}

void Drawing::Curve(const Panel& panel, const Axis& axis, const Value& value,
                    absl::string_view color, bool steps, bool filled) {
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

void Drawing::Dot(double x, double y, absl::string_view color) {
  absl::StrAppendFormat(&svg_,
                        "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"%s\" stroke=\"#ffffff\" "
                        "stroke-width=\"1.5\"/>\n",
                        x, y, color);
}

std::string Drawing::Finish() const { return absl::StrCat(svg_, "</svg>\n"); }

void Drawing::SideTitle(double x, const Panel& panel, absl::string_view title,
                        absl::string_view color) {
  const double y = (panel.top + panel.bottom) / 2;
  Text(x, y, "middle",
       absl::StrFormat(" transform=\"rotate(-90 %.1f %.1f)\" fill=\"%s\"", x, y, color), title);
}

}  // namespace cleave
