#ifndef CLEAVE_CLIENT_IO_PLOT_DRAWING_H_
#define CLEAVE_CLIENT_IO_PLOT_DRAWING_H_

#include <functional>
#include <span>
#include <string>

#include "absl/strings/string_view.h"
#include "client/io/plot/axis.h"
#include "client/io/plot/plot.h"

namespace cleave {

// Where things lie in the picture, in its units, y down.
inline constexpr double kPlotWidth = 900;
inline constexpr double kPlotHeight = 620;
inline constexpr double kPlotLeft = 88;
inline constexpr double kPlotRight = kPlotWidth - 84;
struct Panel {
  double top;
  double bottom;
};

// Text as XML takes it: reserved characters escaped, control characters left out.
std::string EscapedForXml(absl::string_view text);

// Builds the SVG of a plot over a common time axis, element by element.
class Drawing {
 public:
  using Value = std::function<double(const PlotSample&)>;

  // The arguments must outlive this object.
  Drawing(std::span<const PlotSample> samples, const Axis& time);

  // `attributes` begin with a blank; `text` is XML already.
  void Text(double x, double y, absl::string_view anchor, absl::string_view attributes,
            absl::string_view text);
  void Line(double x1, double y1, double x2, double y2, absl::string_view attributes);
  void Dot(double x, double y, absl::string_view color);
  // Ground, grid, ticks and title of a panel's left axis.
  void Frame(const Panel& panel, const Axis& axis, absl::string_view title,
             absl::string_view color);
  void RightAxis(const Panel& panel, const Axis& axis, absl::string_view title,
                 absl::string_view color);
  void TimeAxis(const Panel& panel);
  // A curve; counts hold their value until the next sample (`steps`) and may be filled below.
  void Curve(const Panel& panel, const Axis& axis, const Value& value, absl::string_view color,
             bool steps, bool filled);

  double X(double time) const;
  static double Y(const Panel& panel, const Axis& axis, double value);

  std::string Finish() const;

 private:
  void SideTitle(double x, const Panel& panel, absl::string_view title, absl::string_view color);

  std::span<const PlotSample> samples_;
  const Axis& time_;
  std::string svg_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PLOT_DRAWING_H_
