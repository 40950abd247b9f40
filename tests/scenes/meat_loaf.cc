#include "tests/scenes/meat_loaf.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/status.h"
#include "tests/metrics/pieces.h"
#include "tests/metrics/statistics.h"
#include "tests/scenes/scene_parts.h"
#include "tests/scenes/shapes.h"

namespace cleave {
namespace {

constexpr Vec3 kSize{0.25, 0.1, 0.1};  // m
constexpr double kExponent = 4;
constexpr double kCrust = 0.15;     // of the half size
constexpr double kGrip = 0.03;      // m at each end
constexpr int32_t kBread = 1;       // region
constexpr double kShoulder = 0.02;  // m on both sides of a grip's end
constexpr double kPull = 0.25;      // m, of each end
constexpr int64_t kFrames = 100;

}  // namespace

absl::StatusOr<Demonstration> MakeMeatLoaf(const Setting& setting) {
  Demonstration made;
  made.cell_size = 0.0105 * setting.coarseness;
  CLEAVE_ASSIGN_OR_RETURN(
      made.mesh,
      SuperellipsoidLoaf(kSize, kExponent, {setting.layout, made.cell_size, 0.2, setting.seed}));
  made.mesh.regions.push_back({0, "meat"});
  NameRegion(made.mesh, kBread, "bread",
             [](const Vec3& x) { return SuperellipsoidDepth(x, kSize, kExponent) < kCrust; });
  made.fibres.assign(made.mesh.tets.size(), Vec3{1, 0, 0});
  made.rest_length = kSize[0] - 2 * kGrip;

  Scene& scene = made.scene;
  scene.name = "meat loaf";
  scene.seed = setting.seed;
  Material meat;
  meat.name = "meat";
  meat.youngs_modulus = 1e5;
  meat.poisson_ratio = 0.4;
  meat.density = 1050;
  meat.tensile_strength = 5.5e4;
  FibreFamily family;
  family.stiffness = 3e4;
  family.direction = ConstantDirection{{1, 0, 0}};
  family.strength_ratio = 2;
  meat.fibres.push_back(family);
  meat.strands = Strands{0.2, 3};
  scene.materials.push_back(meat);
  if (setting.variant == "loaf") {
    Material bread;
    bread.name = "bread";
    bread.regions = {"bread"};
    bread.youngs_modulus = 6e4;
    bread.poisson_ratio = 0.2;
    bread.density = 300;
    bread.tensile_strength = 5e3;
    scene.materials.push_back(bread);
  }
  Impurities flaws;
  flaws.noise = 0.1;
  scene.impurities = flaws;

  GripEnds(made, kSize[0], kGrip);
  // Held along x alone: grips that keep the ends from thinning would split the meat at its skin.
  AddMotion(scene, "left end", {true, false, false}, PullBy({-kPull, 0, 0}, 1));
  made.pull_motion = AddMotion(scene, "right end", {true, false, false}, PullBy({kPull, 0, 0}, 1));
  Reinforce(scene, kSize[0] / 2 - kGrip, kShoulder);
  SetPace(scene, 1, kFrames);
  return made;
}

Metrics MeasureMeatLoaf(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run) {
  const TetMesh& mesh = demonstration.mesh;
  // 0: meat, 1: bread, 2: on the border between them.
  std::vector<uint8_t> part(incidence.edges.size());
  double counts[3] = {0, 0, 0};
  for (size_t edge = 0; edge < part.size(); ++edge) {
    const auto tets = incidence.edge_tets[static_cast<int64_t>(edge)];
    const auto bread = std::count_if(tets.begin(), tets.end(),
                                     [&](int32_t tet) { return mesh.region_of(tet) == kBread; });
    part[edge] = bread == 0 ? 0 : bread == static_cast<int64_t>(tets.size()) ? 1 : 2;
    ++counts[part[edge]];
  }
  double first[3] = {-1, -1, -1};
  double broken[3] = {0, 0, 0};
  for (size_t i = 0; i < run.frames.size(); ++i) {
    double now[3] = {0, 0, 0};
    for (const int32_t edge : run.frames[i].broken_edges) ++now[part[static_cast<size_t>(edge)]];
    for (size_t k = 0; k < 3; ++k) {
      broken[k] = now[k] / counts[k];
      if (first[k] < 0 && broken[k] > 0.001) first[k] = static_cast<double>(i);
    }
  }
  std::vector<double> stretches[3];
  for (const FailureStretch& failure : FailureStretches(mesh, incidence, run.frames))
    stretches[part[static_cast<size_t>(failure.edge)]].push_back(failure.stretch);
  Metrics metrics;
  metrics["first_meat"] = first[0];
  metrics["first_bread"] = first[1];
  metrics["broken_meat"] = broken[0];
  metrics["broken_bread"] = broken[1];
  if (!stretches[0].empty() && !stretches[1].empty())
    metrics["stretch_ratio"] = Median(stretches[0]) / Median(stretches[1]);
  return metrics;
}

std::vector<Criterion> MeatLoafCriteria() {
  // The shell splits before the core, at less stretch and in more places.
  const auto shell_first = [](const std::string& variant) -> std::vector<Condition> {
    return {
        {"frame in which bread first breaks", Of(variant, "first_bread"), Relation::kAtLeast, 0},
        {"frames from first broken meat to first broken bread",
         Difference(Of(variant, "first_bread"), Of(variant, "first_meat")), Relation::kBelow, 0},
        {"median stretch at failure, meat over bread", Of(variant, "stretch_ratio"),
         Relation::kAtLeast, 1.3},
        {"broken share, bread beyond meat",
         Difference(Of(variant, "broken_bread"), Of(variant, "broken_meat")), Relation::kAbove, 0}};
  };
  return {
      {"The shell of bread splits before the core of meat", {"loaf"}, shell_first("loaf")},
      {"Of meat throughout, the outer part does not split first",
       {"meat"},
       shell_first("meat"),
       true,
       kAll},
  };
}

}  // namespace cleave
