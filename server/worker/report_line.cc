#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "server/worker/recorded_simulation.h"

namespace cleave {
namespace {

// JSON has no infinities.
std::string Number(double value) {
  return std::isfinite(value) ? absl::StrFormat("%.17g", value) : "null";
}

std::string Text(absl::string_view text) { return absl::StrCat("\"", text, "\""); }

std::string List(const std::vector<std::string>& texts) {
  std::vector<std::string> quoted;
  for (const std::string& text : texts) quoted.push_back(Text(text));
  return absl::StrCat("[", absl::StrJoin(quoted, ","), "]");
}

// Members of a JSON object, in the order in which they are added.
class Object {
 public:
  void Add(absl::string_view name, const std::string& value) {
    absl::StrAppend(&members_, members_.empty() ? "" : ",", "\"", name, "\":", value);
  }
  std::string Str() const { return absl::StrCat("{", members_, "}"); }

 private:
  std::string members_;
};

const char* NameOf(ElasticLaw law) {
  switch (law) {
    case ElasticLaw::kStableNeoHookean:
      return "stable_neo_hookean";
    case ElasticLaw::kInvertibleNeoHookean:
      return "invertible_neo_hookean";
    case ElasticLaw::kCorotatedLinear:
      return "corotated_linear";
    case ElasticLaw::kStVenantKirchhoff:
      return "st_venant_kirchhoff";
  }
  return "";
}

const char* NameOf(ImpurityModel model) {
  switch (model) {
    case ImpurityModel::kGraph:
      return "graph";
    case ImpurityModel::kStatic:
      return "static";
    case ImpurityModel::kUncorrelated:
      return "uncorrelated";
    case ImpurityModel::kOff:
      return "off";
  }
  return "";
}

// The laws of the materials, each once.
std::vector<std::string> LawsOf(const Scene& scene) {
  std::vector<std::string> laws;
  for (const Material& material : scene.materials) {
    const std::string law = NameOf(material.law);
    if (std::find(laws.begin(), laws.end(), law) == laws.end()) laws.push_back(law);
  }
  return laws;
}

// What the scene has besides a body, by the names of its fields and those of materials.
std::vector<std::string> PartsOf(const Scene& scene) {
  std::vector<std::string> parts;
  const auto add = [&](const char* name, bool present) {
    if (present) parts.emplace_back(name);
  };
  const auto any = [&](const auto& has) {
    return std::any_of(scene.materials.begin(), scene.materials.end(), has);
  };
  add("gravity", scene.gravity.has_value());
  add("motions", !scene.motions.empty());
  add("loads", !scene.loads.empty());
  add("initial_velocities", !scene.initial_velocities.empty());
  add("colliders", !scene.colliders.empty());
  add("contact", scene.contact.has_value());
  add("sleep", scene.sleep.has_value());
  add("fibres", any([](const Material& material) { return !material.fibres.empty(); }));
  add("plasticity", any([](const Material& material) { return material.plasticity.has_value(); }));
  add("tensile_strength",
      any([](const Material& material) { return material.tensile_strength.has_value(); }));
  add("compressive_strength",
      any([](const Material& material) { return material.compressive_strength.has_value(); }));
  add("fatigue", Tires(scene));
  add("strands", PullsStrands(scene));
  add("weakenings", WeakensEdges(scene));
  return parts;
}

}  // namespace

std::string InForce(const Scene& scene) {
  Object all;
  const Quality& quality = scene.quality;
  all.Add("precision", Text(quality.precision == Precision::kFloat ? "float" : "double"));
  all.Add("residual_tolerance", Number(quality.residual_tolerance));
  all.Add("step_tolerance", Number(quality.step_tolerance));
  all.Add("linear_tolerance", Number(quality.linear_tolerance));
  all.Add("newton_iterations", absl::StrCat(quality.newton_iterations));
  all.Add("max_step_halvings", absl::StrCat(quality.max_step_halvings));
  all.Add("time_step", Number(1 / (scene.timing.frames_per_second * scene.timing.steps_per_frame)));
  all.Add("parts", List(PartsOf(scene)));
  all.Add("laws", List(LawsOf(scene)));
  if (IsDamped(scene)) {
    Object damping;
    damping.Add("mass_coefficient", Number(scene.damping->mass_coefficient));
    damping.Add("stiffness_coefficient", Number(scene.damping->stiffness_coefficient));
    all.Add("damping", damping.Str());
  }
  if (!CanBreak(scene)) return all.Str();
  Object fracture;
  fracture.Add("stress",
               Text(scene.fracture.stress == FractureStress::kTotal ? "total" : "matrix"));
  fracture.Add("aggregation",
               Text(scene.fracture.aggregation == StressAggregation::kMax ? "max" : "mean"));
  fracture.Add("reformulation",
               Text(scene.fracture.reformulation == Reformulation::kEdgeProjected ? "edge_projected"
                                                                                  : "uniform"));
  fracture.Add("simultaneity", Number(scene.fracture.simultaneity));
  fracture.Add("max_passes", absl::StrCat(scene.fracture.max_passes));
  all.Add("fracture", fracture.Str());
  if (scene.impurities) {
    Object impurities;
    impurities.Add("effect",
                   Text(scene.impurities->effect == ImpurityEffect::kUpgradation ? "upgradation"
                                                                                 : "degradation"));
    impurities.Add("model", Text(NameOf(scene.impurities->model)));
    impurities.Add("mode",
                   Text(scene.impurities->mode == ImpurityMode::kSampled ? "sampled" : "expected"));
    impurities.Add("seed", absl::StrCat(scene.seed));
    all.Add("impurities", impurities.Str());
  }
  return all.Str();
}

v1::Progress ProgressOf(const FrameReport& report) {
  v1::Progress progress;
  progress.set_time(report.time);
  progress.set_broken_edges(report.broken_edges);
  progress.set_fragments(report.fragments);
  progress.set_seconds_per_frame(report.total_seconds);
  return progress;
}

std::string ReportLine(const FrameReport& report, absl::string_view in_force) {
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
  add("damping_dissipation", Number(report.damping_dissipation));
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
  add("in_force", std::string(in_force));
  line += '}';
  return line;
}

}  // namespace cleave
