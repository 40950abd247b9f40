#include "client/io/plot/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cleave {
namespace {

double Place(const Axis& axis, double value, double from, double to) {
  return from + (value - axis.low) / (axis.high - axis.low) * (to - from);
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

Drawing::Drawing(const Axis& horizontal, double height) : horizontal_(horizontal) {
  absl::StrAppendFormat(
      &svg_,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" "
      "height=\"%g\" font-family=\"'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', "
      "sans-serif\" font-size=\"14\" fill=\"#333\">\n"
      "<rect width=\"%g\" height=\"%g\" fill=\"#ffffff\"/>\n",
      kPlotWidth, height, kPlotWidth, height, kPlotWidth, height);
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

double Drawing::X(double value) const { return Place(horizontal_, value, kPlotLeft, kPlotRight); }
double Drawing::Y(const Panel& panel, const Axis& axis, double value) {
  return Place(axis, value, panel.bottom, panel.top);
}

void Drawing::Frame(const Panel& panel, const Axis& axis, absl::string_view title,
                    absl::string_view color) {
  absl::StrAppendFormat(&svg_,
                        "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"#f7f8fa\"/>\n",
                        kPlotLeft, panel.top, kPlotRight - kPlotLeft, panel.bottom - panel.top);
  for (const double tick : horizontal_.ticks) {
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

void Drawing::HorizontalAxis(const Panel& panel, absl::string_view title) {
  for (size_t i = 0; i < horizontal_.ticks.size(); ++i) {
    Text(X(horizontal_.ticks[i]), panel.bottom + 22, "middle", "", horizontal_.labels[i]);
  }
  Text((kPlotLeft + kPlotRight) / 2, panel.bottom + 46, "middle", "", title);
}

void Drawing::Curve(const Panel& panel, const Axis& axis, std::span<const PlotPoint> points,
                    absl::string_view color, CurveStyle style) {
  if (points.empty()) return;
  const bool steps = style == CurveStyle::kSteps || style == CurveStyle::kFilledSteps;
  std::string path;
  double last_y = 0;
  for (const PlotPoint& point : points) {
    const double x = X(point.x);
    const double y = Y(panel, axis, point.y);
    if (path.empty()) {
      absl::StrAppendFormat(&path, "M%.2f %.2f", x, y);
    } else {
      if (steps && y != last_y) absl::StrAppendFormat(&path, "L%.2f %.2f", x, last_y);
      absl::StrAppendFormat(&path, "L%.2f %.2f", x, y);
    }
    last_y = y;
  }
  if (style == CurveStyle::kFilled || style == CurveStyle::kFilledSteps) {
    const double base = Y(panel, axis, std::max(axis.low, 0.0));
    absl::StrAppendFormat(
        &svg_, "<path d=\"%sL%.2f %.2fL%.2f %.2fZ\" fill=\"%s\" fill-opacity=\"0.13\"/>\n", path,
        X(points.back().x), base, X(points.front().x), base, color);
  }
  absl::StrAppendFormat(&svg_,
                        "<path d=\"%s\" fill=\"none\" stroke=\"%s\" %s"
                        "stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n",
                        path, color,
                        style == CurveStyle::kDashed
                            ? "stroke-width=\"1.6\" stroke-dasharray=\"2 5\" "
                            : "stroke-width=\"2.2\" ");
}

void Drawing::Dot(double x, double y, absl::string_view color) {
  absl::StrAppendFormat(&svg_,
                        "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4.5\" fill=\"%s\" stroke=\"#ffffff\" "
                        "stroke-width=\"1.5\"/>\n",
                        x, y, color);
}

void Drawing::Cross(double x, double y, absl::string_view color) {
  for (const auto& [stroke, width] :
       {std::pair<absl::string_view, double>{"#ffffff", 5.5}, {color, 2.6}}) {
    absl::StrAppendFormat(&svg_,
                          "<path d=\"M%.1f %.1fL%.1f %.1fM%.1f %.1fL%.1f %.1f\" stroke=\"%s\" "
                          "stroke-width=\"%g\" stroke-linecap=\"round\"/>\n",
                          x - 5, y - 5, x + 5, y + 5, x - 5, y + 5, x + 5, y - 5, stroke, width);
  }
}

std::string Drawing::Finish() const { return absl::StrCat(svg_, "</svg>\n"); }

void Drawing::SideTitle(double x, const Panel& panel, absl::string_view title,
                        absl::string_view color) {
  const double y = (panel.top + panel.bottom) / 2;
  Text(x, y, "middle",
       absl::StrFormat(" transform=\"rotate(-90 %.1f %.1f)\" fill=\"%s\"", x, y, color), title);
}

}  // namespace cleave
