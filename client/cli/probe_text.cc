#include "client/cli/probe_text.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "client/io/plot/axis.h"

namespace cleave {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

// "1 0 0", with numbers as short as they may be, of a direction: what is close to 0 is shown as 0.
std::string VectorText(const Numbers& v) {
  std::string text;
  double length = 0;
  for (const double x : v) length = std::hypot(length, x);
  for (const double x : v)
    absl::StrAppend(&text, text.empty() ? "" : " ",
                    absl::StrFormat("%.3g", std::abs(x) < 1e-5 * length ? 0 : x));
  return text;
}

absl::string_view LawText(v1::ElasticLaw law) {
  switch (law) {
    case v1::ELASTIC_LAW_INVERTIBLE_NEO_HOOKEAN:
      return "invertible Neo-Hookean";
    case v1::ELASTIC_LAW_COROTATED_LINEAR:
      return "corotated linear";
    case v1::ELASTIC_LAW_ST_VENANT_KIRCHHOFF:
      return "St. Venant-Kirchhoff";
    default:
      return "stable Neo-Hookean";
  }
}

std::string FibreDirectionText(const v1::FibreFamily& family) {
  switch (family.direction_case()) {
    case v1::FibreFamily::kConstant:
      return absl::StrCat("along ", VectorText(family.constant().vector()));
    case v1::FibreFamily::kCylindrical:
      return absl::StrCat("in the cylindrical frame of ", VectorText(family.cylindrical().axis()));
    case v1::FibreFamily::kPerTet:
      return "with a direction a tet";
    default:
      return "along curves";
  }
}

absl::string_view EndVerb(v1::CurveEnd end) {
  switch (end) {
    case v1::CURVE_END_TENSILE_STRENGTH:
    case v1::CURVE_END_DIRECTIONAL_STRENGTH:
    case v1::CURVE_END_FAILURE_STRAIN:
      return "breaks at";
    case v1::CURVE_END_COMPRESSIVE_STRENGTH:
      return "is crushed at";
    case v1::CURVE_END_NO_EQUILIBRIUM:
      return "gives way at";
    default:
      return "holds up to";
  }
}

// "pulled along 1 0 0"
std::string PullText(const v1::StressStrainCurve& curve) {
  const bool pressed = !curve.strain().empty() && *curve.strain().rbegin() < 0;
  return absl::StrCat(pressed ? "pressed along " : "pulled along ", VectorText(curve.direction()));
}

// As few rows as read well: the first, the last and some in between.
std::vector<int> ShownRows(int count) {
  constexpr int kRows = 10;
  std::vector<int> rows;
  const int steps = std::min(kRows, count - 1);
  for (int k = 0; k <= steps; ++k)
    rows.push_back(
        steps == 0 ? 0
                   : static_cast<int>(std::lround(static_cast<double>(k) * (count - 1) / steps)));
  return rows;
}

std::string CurveTable(const v1::StressStrainCurve& curve) {
  std::string text =
      absl::StrCat(PullText(curve), ": Young's modulus ", WithPrefix(curve.youngs_modulus(), "Pa"),
                   "; ", CurveEndText(curve), "\n");
  const bool flows = curve.plastic_strain(curve.plastic_strain_size() - 1) > 0;
  absl::StrAppendFormat(&text, "  %12s %15s %12s %13s %14s %14s%s\n", "strain", "nominal stress",
                        "true stress", "volume ratio", "energy", "failure ratio",
                        flows ? "  plastic strain" : "");
  for (const int k : ShownRows(curve.strain_size())) {
    absl::StrAppendFormat(
        &text, "  %10.4g %% %15s %12s %13.6g %14s %14.3f%s\n", 100 * curve.strain(k),
        WithPrefix(curve.nominal_stress(k), "Pa"), WithPrefix(curve.true_stress(k), "Pa"),
        curve.volume_ratio(k), WithPrefix(curve.energy(k), "J/m^3"), curve.failure_ratio(k),
        flows ? absl::StrFormat("  %12.4g %%", 100 * curve.plastic_strain(k)) : "");
  }
  return text;
}

std::string MatrixRows(const Numbers& numbers, int first, int width, int digits) {
  std::string text;
  for (int row = 0; row < width; ++row) {
    absl::StrAppend(&text, "   ");
    for (int column = 0; column < width; ++column)
      absl::StrAppendFormat(&text, " %*.*g", digits + 7, digits,
                            numbers[first + width * row + column]);
    absl::StrAppend(&text, "\n");
  }
  return text;
}

}  // namespace

std::string MaterialText(const v1::Material& material) {
  std::string text = absl::StrFormat(
      "%s solid, Young's modulus %s, Poisson's ratio %g, density %g kg/m^3, %s",
      LawText(material.law()), WithPrefix(material.youngs_modulus(), "Pa"),
      material.poisson_ratio(), material.density(),
      material.has_tensile_strength() && std::isfinite(material.tensile_strength())
          ? absl::StrCat("tensile strength ", WithPrefix(material.tensile_strength(), "Pa"))
          : "never breaks");
  if (material.has_compressive_strength())
    absl::StrAppend(&text, ", compressive strength ",
                    WithPrefix(material.compressive_strength(), "Pa"));
  if (material.has_plasticity()) {
    const v1::Plasticity& plasticity = material.plasticity();
    absl::StrAppend(&text, "\n  yields at ", WithPrefix(plasticity.yield_stress(), "Pa"),
                    ", hardens by ", WithPrefix(plasticity.hardening(), "Pa"));
    if (plasticity.has_failure_strain())
      absl::StrAppendFormat(&text, ", breaks at a plastic strain of %.3g %%",
                            100 * plasticity.failure_strain());
  }
  for (const v1::FibreFamily& family : material.fibres()) {
    absl::StrAppend(&text, "\n  fibres ", FibreDirectionText(family), ": ",
                    WithPrefix(family.stiffness(), "Pa"), ", ",
                    absl::StrFormat("%g times as strong along as across", family.strength_ratio()));
  }
  return text;
}

std::string CurveEndText(const v1::StressStrainCurve& curve) {
  const int last = curve.strain_size() - 1;
  const std::string where =
      absl::StrFormat("at a strain of %.3g %% and %s", 100 * curve.strain(last),
                      WithPrefix(curve.nominal_stress(last), "Pa"));
  const std::string edge = absl::StrCat("of edges along ", VectorText(curve.worst_edge()));
  switch (curve.end()) {
    case v1::CURVE_END_TENSILE_STRENGTH:
      return absl::StrCat("breaks ", where, " (tensile strength ", edge, ")");
    case v1::CURVE_END_DIRECTIONAL_STRENGTH:
      return absl::StrCat("breaks ", where, " (strength with fibres ", edge, ")");
    case v1::CURVE_END_COMPRESSIVE_STRENGTH:
      return absl::StrCat("is crushed ", where, " (compressive strength ", edge, ")");
    case v1::CURVE_END_FAILURE_STRAIN:
      return absl::StrCat("breaks ", where, " (plastic strain ",
                          absl::StrFormat("%.3g %%)", 100 * curve.plastic_strain(last)));
    case v1::CURVE_END_NO_EQUILIBRIUM:
      return absl::StrCat("gives way ", where);
    default:
      return absl::StrCat("holds up to the largest strain, ",
                          absl::StrFormat("%.3g %%", 100 * curve.strain(last)), " and ",
                          WithPrefix(curve.nominal_stress(last), "Pa"));
  }
}

std::string ProbeTable(const v1::ProbeMaterialRequest& request,
                       const v1::ProbeMaterialResponse& response) {
  std::string text = MaterialText(response.material()) + "\n";
  for (const v1::StressStrainCurve& curve : response.curves())
    absl::StrAppend(&text, "\n", CurveTable(curve));
  for (int i = 0; i < response.points_size(); ++i) {
    const v1::ProbedPoint& point = response.points(i);
    absl::StrAppend(&text, "\ndeformation gradient\n",
                    MatrixRows(request.deformation_gradients(), 9 * i, 3, 6), "  energy ",
                    WithPrefix(point.energy(), "J/m^3"), "\n  first Piola-Kirchhoff stress [Pa]\n",
                    MatrixRows(point.stress(), 0, 3, 6),
                    "  tangent, d stress / d gradient, both row by row [Pa]\n",
                    MatrixRows(point.tangent(), 0, 9, 4));
  }
  text.pop_back();
  return text;
}

std::string CurvesCsv(const v1::ProbeMaterialResponse& response) {
  std::string text =
      "curve,direction_x,direction_y,direction_z,strain,nominal_stress_pa,true_stress_pa,"
      "volume_ratio,energy_j_per_m3,failure_ratio,plastic_strain\n";
  for (int i = 0; i < response.curves_size(); ++i) {
    const v1::StressStrainCurve& curve = response.curves(i);
    for (int k = 0; k < curve.strain_size(); ++k) {
      absl::StrAppendFormat(
          &text, "%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", i,
          curve.direction(0), curve.direction(1), curve.direction(2), curve.strain(k),
          curve.nominal_stress(k), curve.true_stress(k), curve.volume_ratio(k), curve.energy(k),
          curve.failure_ratio(k), curve.plastic_strain(k));
    }
  }
  return text;
}

std::string PointsCsv(const v1::ProbeMaterialRequest& request,
                      const v1::ProbeMaterialResponse& response) {
  std::string text;
  const auto headings = [&](absl::string_view name, int width, absl::string_view unit) {
    for (int k = 0; k < width * width; ++k)
      absl::StrAppend(&text, name, k / width + 1, "_", k % width + 1, unit, ",");
  };
  headings("f", 3, "");
  absl::StrAppend(&text, "energy_j_per_m3,plastic_strain,");
  headings("p", 3, "_pa");
  headings("k", 9, "_pa");
  text.back() = '\n';
  const auto numbers = [&](const Numbers& from, int first, int count) {
    for (int k = 0; k < count; ++k) absl::StrAppendFormat(&text, "%.17g,", from[first + k]);
  };
  for (int i = 0; i < response.points_size(); ++i) {
    numbers(request.deformation_gradients(), 9 * i, 9);
    absl::StrAppendFormat(&text, "%.17g,%.17g,", response.points(i).energy(),
                          response.points(i).plastic_strain());
    numbers(response.points(i).stress(), 0, 9);
    numbers(response.points(i).tangent(), 0, 81);
    text.back() = '\n';
  }
  return text;
}

std::vector<PlottedCurve> PlottedCurves(const v1::ProbeMaterialResponse& response) {
  std::vector<PlottedCurve> curves;
  for (const v1::StressStrainCurve& curve : response.curves()) {
    PlottedCurve& plotted = curves.emplace_back();
    const int last = curve.strain_size() - 1;
    const bool breaks = curve.end() == v1::CURVE_END_TENSILE_STRENGTH ||
                        curve.end() == v1::CURVE_END_DIRECTIONAL_STRENGTH;
    plotted.label = absl::StrCat(
        PullText(curve), ": ", WithPrefix(curve.youngs_modulus(), "Pa"), ", ", EndVerb(curve.end()),
        absl::StrFormat(" %.3g %%, ", 100 * curve.strain(last)),
        WithPrefix(curve.nominal_stress(last), "Pa"),
        breaks ? absl::StrCat(", edges along ", VectorText(curve.worst_edge()), " first") : "");
    plotted.strain.assign(curve.strain().begin(), curve.strain().end());
    plotted.nominal_stress.assign(curve.nominal_stress().begin(), curve.nominal_stress().end());
    plotted.true_stress.assign(curve.true_stress().begin(), curve.true_stress().end());
    plotted.fails = curve.end() != v1::CURVE_END_LARGEST_STRAIN;
  }
  return curves;
}

std::string PlotSubtitle(const v1::Material& material) {
  std::string text =
      absl::StrFormat("%s; E %s, ν %.3g", LawText(material.law()),
                      WithPrefix(material.youngs_modulus(), "Pa"), material.poisson_ratio());
  if (material.has_tensile_strength() && std::isfinite(material.tensile_strength()))
    absl::StrAppend(&text, ", strength ", WithPrefix(material.tensile_strength(), "Pa"));
  if (material.has_plasticity())
    absl::StrAppend(&text, ", yield ", WithPrefix(material.plasticity().yield_stress(), "Pa"));
  for (const v1::FibreFamily& family : material.fibres())
    absl::StrAppend(&text, "; fibres ", WithPrefix(family.stiffness(), "Pa"));
  return text;
}

std::string PresetsText(const v1::ListMaterialPresetsResponse& presets) {
  std::string text;
  for (const v1::MaterialPreset& preset : presets.presets()) {
    absl::StrAppend(&text, text.empty() ? "" : "\n", preset.name(), ": ", preset.description(),
                    "\n  ", MaterialText(preset.material()), "\n");
    for (const std::string& source : preset.sources()) absl::StrAppend(&text, "  - ", source, "\n");
  }
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace cleave
