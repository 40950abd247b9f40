#ifndef CLEAVE_CLIENT_IO_PLOT_DRAWING_H_
#define CLEAVE_CLIENT_IO_PLOT_DRAWING_H_

#include <span>
#include <string>

#include "absl/strings/string_view.h"
#include "client/io/plot/axis.h"

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

// A point of a curve, in the units of the axes.
struct PlotPoint {
  double x;
  double y;
};
enum class CurveStyle {
  kPlain,
  kDashed,
  kFilled,       // down to zero
  kSteps,        // counts, which hold their value until the next point
  kFilledSteps,  // both
};

// Builds the SVG of a plot over a common horizontal axis, element by element.
class Drawing {
 public:
  // `horizontal` must outlive this object.
  explicit Drawing(const Axis& horizontal, double height = kPlotHeight);

  // `attributes` begin with a blank; `text` is XML already.
  void Text(double x, double y, absl::string_view anchor, absl::string_view attributes,
            absl::string_view text);
  void Line(double x1, double y1, double x2, double y2, absl::string_view attributes);
  void Dot(double x, double y, absl::string_view color);
  void Cross(double x, double y, absl::string_view color);
  // Ground, grid, ticks and title of a panel's left axis.
  void Frame(const Panel& panel, const Axis& axis, absl::string_view title,
             absl::string_view color);
  void RightAxis(const Panel& panel, const Axis& axis, absl::string_view title,
                 absl::string_view color);
  void HorizontalAxis(const Panel& panel, absl::string_view title);
  void Curve(const Panel& panel, const Axis& axis, std::span<const PlotPoint> points,
             absl::string_view color, CurveStyle style);

  double X(double value) const;
  static double Y(const Panel& panel, const Axis& axis, double value);

  std::string Finish() const;

 private:
  void SideTitle(double x, const Panel& panel, absl::string_view title, absl::string_view color);

  const Axis& horizontal_;
  std::string svg_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PLOT_DRAWING_H_
