#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/worker/recorded_simulation.h"

namespace cleave {
namespace {

// JSON has no infinities.
std::string Number(double value) {
  return std::isfinite(value) ? absl::StrFormat("%.17g", value) : "null";
}

}  // namespace

v1::Progress ProgressOf(const FrameReport& report) {
  v1::Progress progress;
  progress.set_time(report.time);
  progress.set_broken_edges(report.broken_edges);
  progress.set_fragments(report.fragments);
  progress.set_seconds_per_frame(report.total_seconds);
  return progress;
}

std::string ReportLine(const FrameReport& report) {
  std::string line = absl::StrCat("{\"frame\":", report.frame);
  const auto add = [&line](absl::string_view name, const std::string& value) {
    absl::StrAppend(&line, ",\"", name, "\":", value);
  };
  add("time", Number(report.time));
  add("steps", absl::StrCat(report.steps));
  add("step_halvings", absl::StrCat(report.step_halvings));
  add("newton_iterations", absl::StrCat(report.newton_iterations));
  add("linear_iterations", absl::StrCat(report.linear_iterations));
  add("break_passes", absl::StrCat(report.break_passes));
  add("residual", Number(report.residual));
  add("kinetic_energy", Number(report.kinetic_energy));
  add("elastic_energy", Number(report.elastic_energy));
  add("external_work", Number(report.external_work));
  add("fracture_energy", Number(report.fracture_energy));
  add("plastic_work", Number(report.plastic_work));
  add("contact_energy", Number(report.contact_energy));
  add("friction_dissipation", Number(report.friction_dissipation));
  add("integration_dissipation", Number(report.integration_dissipation));
  add("broken_edges", absl::StrCat(report.broken_edges));
  add("new_broken_edges", absl::StrCat(report.new_broken_edges));
  add("fragments", absl::StrCat(report.fragments));
  if (report.sleeping_pieces) add("sleeping_pieces", absl::StrCat(*report.sleeping_pieces));
  std::string forces;
  for (const Vec3& force : report.motion_forces) {
    absl::StrAppend(&forces, forces.empty() ? "" : ",", "[", Number(force[0]), ",",
                    Number(force[1]), ",", Number(force[2]), "]");
  }
  add("motion_forces", absl::StrCat("[", forces, "]"));
  if (!report.colliders.empty()) {
    std::string places;
    for (const ColliderPlace& place : report.colliders) {
      const auto& [w, x, y, z] = place.rotation;
      absl::StrAppend(&places, places.empty() ? "" : ",", "{\"rotation\":[", Number(w), ",",
                      Number(x), ",", Number(y), ",", Number(z), "],\"translation\":[",
                      Number(place.translation[0]), ",", Number(place.translation[1]), ",",
                      Number(place.translation[2]), "]}");
    }
    add("colliders", absl::StrCat("[", places, "]"));
  }
  add("assembly_seconds", Number(report.assembly_seconds));
  add("linear_solve_seconds", Number(report.linear_solve_seconds));
  add("fracture_seconds", Number(report.fracture_seconds));
  add("total_seconds", Number(report.total_seconds));
  add("shortest_step", Number(report.shortest_step));
  const Quality& quality = report.quality;
  const char* precision = quality.precision == Precision::kFloat ? "float" : "double";
  add("in_force", absl::StrCat("{\"precision\":\"", precision,
                               "\",\"residual_tolerance\":", Number(quality.residual_tolerance),
                               ",\"step_tolerance\":", Number(quality.step_tolerance),
                               ",\"linear_tolerance\":", Number(quality.linear_tolerance),
                               ",\"newton_iterations\":", quality.newton_iterations,
                               ",\"max_step_halvings\":", quality.max_step_halvings, "}"));
  line += '}';
  return line;
}

}  // namespace cleave
