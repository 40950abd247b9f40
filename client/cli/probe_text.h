#ifndef CLEAVE_CLIENT_CLI_PROBE_TEXT_H_
#define CLEAVE_CLIENT_CLI_PROBE_TEXT_H_

#include <string>
#include <vector>

#include "cleave/v1/material.pb.h"
#include "client/io/plot/curve_plot.h"

namespace cleave {

// A material in a line or a few: law, moduli, strength, fibres.
std::string MaterialText(const v1::Material& material);

// "breaks at a strain of 0.61 % and 72.6 MPa (tensile strength of edges along 1 0 0)", or how else
// a curve ends. Precondition: the curve has points.
std::string CurveEndText(const v1::StressStrainCurve& curve);

// What a person reads of the answer to a request: about ten lines a curve.
std::string ProbeTable(const v1::ProbeMaterialRequest& request,
                       const v1::ProbeMaterialResponse& response);

// A line a sample of every curve, and a line a gradient, in SI units, with a line of headings.
std::string CurvesCsv(const v1::ProbeMaterialResponse& response);
std::string PointsCsv(const v1::ProbeMaterialRequest& request,
                      const v1::ProbeMaterialResponse& response);

// The curves for a plot, labelled.
std::vector<PlottedCurve> PlottedCurves(const v1::ProbeMaterialResponse& response);

// A material in one line that fits a plot.
std::string PlotSubtitle(const v1::Material& material);

// The presets with numbers and sources, for people.
std::string PresetsText(const v1::ListMaterialPresetsResponse& presets);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_PROBE_TEXT_H_
