#include "tests/scenes/fibre_bar.h"

#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "tests/metrics/crack_surface.h"
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

}  // namespace cleave
