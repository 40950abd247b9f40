#ifndef CLEAVE_CLIENT_IO_PLOT_LABELLED_CURVES_H_
#define CLEAVE_CLIENT_IO_PLOT_LABELLED_CURVES_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/io/plot/axis.h"
#include "client/io/plot/drawing.h"

namespace cleave {

// A curve in a colour of its own, which a legend below names.
struct LabelledCurve {
  std::string label;                   // UTF-8
  std::vector<PlotPoint> points;       // in the units of the axes
  std::vector<PlotPoint> dashed = {};  // another in the same colour; empty: none
  PlotPoint marked{0, 0};              // by a dot
  bool crossed = false;                // by a cross instead
};

// Title and subtitle may be empty; all are UTF-8, those of axes XML already.
struct CurveTitles {
  std::string title;
  std::string subtitle;
  std::string horizontal;
  std::string vertical;
  std::string dashed = {};  // what dashed curves are, for the legend
};

// Of the columns of each curve. InvalidArgument, naming everything wrong: no curves, columns of
// different length or none, numbers that are not finite.
absl::Status CheckColumns(std::span<const std::vector<std::span<const double>>> curves);

// The bytes of an SVG picture, 900 units wide.
std::string DrawLabelledCurves(std::span<const LabelledCurve> curves, const Axis& horizontal,
                               const Axis& vertical, const CurveTitles& titles);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PLOT_LABELLED_CURVES_H_
