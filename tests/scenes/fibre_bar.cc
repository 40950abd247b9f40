#include "tests/scenes/fibre_bar.h"

#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "tests/metrics/crack_surface.h"
#include "tests/metrics/statistics.h"
#include "tests/scenes/scene_parts.h"

namespace cleave {
namespace {

constexpr double kLength = 1;      // m
constexpr double kWidth = 0.3;     // m
constexpr double kGrip = 0.08;     // m at each end
constexpr double kShoulder = 0.2;  // m from each end: stronger, so that grips do not start cracks

}  // namespace

absl::StatusOr<Demonstration> MakeFibreBar(const Setting& setting) {
  const std::string kind = setting.variant.substr(0, setting.variant.find_first_of("0123456789"));
  const double degrees = std::strtod(setting.variant.c_str() + kind.size(), nullptr);

  Demonstration made;
  made.cell_size = 0.043 * setting.coarseness;
  BoxMesh box;
  box.origin = {0, -kWidth / 2, -kWidth / 2};
  box.size = {kLength, kWidth, kWidth};
  box.resolution = {setting.layout, made.cell_size, 0.2, setting.seed};
  CLEAVE_ASSIGN_OR_RETURN(made.mesh, BuildMesh(box));
  made.fibres.assign(made.mesh.tets.size(), InPlane(degrees));
  made.rest_length = kLength - 2 * kGrip;

  Scene& scene = made.scene;
  scene.name = absl::StrCat("bar with fibres at ", degrees, " degrees");
  scene.seed = setting.seed;
  Material material;
  material.name = "fibre compound";
  material.youngs_modulus = 1e6;
  material.poisson_ratio = 0.3;
  material.density = 1000;
  material.tensile_strength = 1e5;
  if (kind != "iso") {
    FibreFamily family;
    family.stiffness = kind == "stiff" ? 1e7 : 3e6;
    family.direction = ConstantDirection{InPlane(degrees)};
    family.strength_ratio = kind == "fibre" ? 3 : 1;
    material.fibres.push_back(family);
  }
  scene.materials.push_back(material);

  made.grip = NodesWhere(made.mesh, [](const Vec3& x) { return x[0] < kGrip; });
  made.pulled = NodesWhere(made.mesh, [](const Vec3& x) { return x[0] > kLength - kGrip; });
  AddNodeSet(scene, "grip", made.grip);
  AddNodeSet(scene, "pulled", made.pulled);
  AddMotion(scene, "grip");
  made.pull_motion = AddMotion(scene, "pulled", {true, true, true}, PullBy({0.4, 0, 0}, 2));
  for (const double end : {0.0, kLength - kShoulder}) {
    scene.weakenings.push_back({BoxSelector{{end, -1, -1}, {end + kShoulder, 1, 1}}, 2});
  }
  Impurities flaws;
  flaws.noise = 0.05;
  scene.impurities = flaws;
  SetPace(scene, 2, 40);
  return made;
}

Metrics MeasureFibreBar(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run) {
  Metrics metrics;
  const auto crack = CrackOfPieces(demonstration.mesh, incidence, run.frames.back().broken_edges);
  metrics["trace_angle"] =
      TraceAngle(crack, {0, 0, 1}, 3 * demonstration.cell_size, demonstration.fibres[0]);
  metrics["crack_center_x"] = CrackCenter(crack)[0];
  return metrics;
}

std::vector<Criterion> FibreBarCriteria() {
  const auto crossing = [](const std::string& kind, const std::string& angle) -> Condition {
    return {absl::StrCat("A(a) over that without fibres, at ", angle, " degrees"),
            Ratio(Of(absl::StrCat(kind, angle), "fibre_crossing_smooth"),
                  Of(absl::StrCat("iso", angle), "fibre_crossing_smooth")),
            Relation::kAtMost, 0.6};
  };
  return {
      {"The more its fibres lie across the pull, the less it holds",
       {"fibre0", "fibre30", "fibre60", "fibre90"},
       {{"rank correlation of angle and peak force",
         [](const Trial& trial) {
           std::vector<double> peaks;
           for (const char* variant : {"fibre0", "fibre30", "fibre60", "fibre90"})
             peaks.push_back(trial.Get(variant, "peak_force"));
           return Spearman(std::vector<double>{0, 30, 60, 90}, peaks);
         },
         Relation::kAtMost, -0.9}}},
      {"It breaks along its fibres",
       {"fibre30", "iso30", "fibre60", "iso60"},
       {crossing("fibre", "30"), crossing("fibre", "60")}},
      {"Fibres that only stiffen do not lead a crack",
       {"plain30", "iso30", "plain60", "iso60"},
       {crossing("plain", "30"), crossing("plain", "60")},
       true},
  };
}

}  // namespace cleave
