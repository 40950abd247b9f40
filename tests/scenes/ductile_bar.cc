#include "tests/scenes/ductile_bar.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "core/mesh/tet_geometry.h"
#include "tests/metrics/pieces.h"
#include "tests/scenes/scene_parts.h"

namespace cleave {
namespace {

constexpr double kLength = 1;        // m
constexpr double kWidth = 0.1;       // m
constexpr double kThickness = 0.04;  // m
constexpr double kGrip = 0.08;       // m at each end
constexpr double kShoulder = 0.16;   // m from each end: stronger, so that grips do not start cracks
constexpr double kPull = 0.7;        // m
constexpr double kSeconds = 6;       // so slow that inertia does not choose where it necks
constexpr size_t kSlices = 20;

// The slice of the bar, of 0.05 m at rest, that a place is in.
size_t SliceOf(double x) {
  return std::min(kSlices - 1, static_cast<size_t>(std::max(0.0, x / kLength) * kSlices));
}

}  // namespace

absl::StatusOr<Demonstration> MakeDuctileBar(const Setting& setting) {
  BoxMesh box;
  box.origin = {0, -kWidth / 2, -kThickness / 2};
  box.size = {kLength, kWidth, kThickness};
  const double cell_size = 0.0135 * setting.coarseness;
  box.resolution = {setting.layout, cell_size, 0.2, setting.seed};
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, BuildMesh(box));
  CLEAVE_ASSIGN_OR_RETURN(Demonstration made, MakeDuctileBarOf(std::move(mesh), setting.variant));
  made.cell_size = cell_size;
  made.scene.seed = setting.seed;
  return made;
}

absl::StatusOr<Demonstration> MakeDuctileBarOf(TetMesh mesh, absl::string_view variant) {
  Vec3 low = mesh.rest_positions.front(), high = low;
  for (const Vec3& x : mesh.rest_positions) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis]);
      high[axis] = std::max(high[axis], x[axis]);
    }
  }
  for (Vec3& x : mesh.rest_positions) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const double from = axis == 0 ? low[0] : 0.5 * (low[axis] + high[axis]);
      x[axis] = (x[axis] - from) * (kLength / (high[0] - low[0]));
    }
  }
  Demonstration made;
  made.mesh = std::move(mesh);
  made.rest_length = kLength - 2 * kGrip;

  Scene& scene = made.scene;
  scene.name = variant == "gold" ? "gold bar" : "gold-copper bar";
  Material gold;
  gold.name = variant == "gold" ? "gold" : "gold-copper";
  gold.youngs_modulus = 1e9;
  gold.poisson_ratio = 0.4;
  gold.density = 19300;
  // Hardening as steep as stress at a strain of 0.1: there it begins to neck.
  gold.tensile_strength = 1.5e7;
  gold.plasticity = Plasticity{.yield_stress = 1e7, .hardening = 1.1e7};
  scene.materials.push_back(gold);
  if (variant != "gold") {
    Impurities copper;
    copper.effect = ImpurityEffect::kUpgradation;
    copper.potency = 0.4;
    if (variant == "off") copper.model = ImpurityModel::kOff;
    scene.impurities = copper;
    made.in_map.assign(made.mesh.rest_positions.size(), 1);
  }

  made.grip = NodesWhere(made.mesh, [](const Vec3& x) { return x[0] < kGrip; });
  made.pulled = NodesWhere(made.mesh, [](const Vec3& x) { return x[0] > kLength - kGrip; });
  AddNodeSet(scene, "grip", made.grip);
  AddNodeSet(scene, "pulled", made.pulled);
  AddMotion(scene, "grip");
  made.pull_motion =
      AddMotion(scene, "pulled", {true, true, true}, PullBy({kPull, 0, 0}, kSeconds));
  for (const double end : {0.0, kLength - kShoulder}) {
    scene.weakenings.push_back({BoxSelector{{end, -1, -1}, {end + kShoulder, 1, 1}}, 3});
  }
  SetPace(scene, kSeconds, 140);
  return made;
}

Metrics MeasureDuctileBar(const Demonstration& demonstration, const Incidence& incidence,
                          const Run& run) {
  const TetMesh& mesh = demonstration.mesh;
  Metrics metrics;
  const auto elongation = [&](int64_t frame) {
    if (frame < 0) return -1.0;
    return kPull * run.frames[static_cast<size_t>(frame)].time / kSeconds /
           demonstration.rest_length;
  };
  metrics["elongation_at_fracture"] = elongation(FirstFracture(run.frames, incidence.edge_count()));
  metrics["elongation_at_separation"] = elongation(run.separation);

  // Plastic strain, by rest volume.
  std::vector<double> strain(kSlices, 0), volume(kSlices, 0);
  double of_bar = 0, bar = 0;
  for (size_t tet = 0; tet < run.plastic_strains.size(); ++tet) {
    const double x = Centroid(mesh, tet)[0];
    if (x < kGrip || x > kLength - kGrip) continue;
    const double size = std::abs(SignedVolume(CornersOf(mesh, static_cast<int64_t>(tet))));
    strain[SliceOf(x)] += size * run.plastic_strains[tet];
    volume[SliceOf(x)] += size;
    of_bar += size * run.plastic_strains[tet];
    bar += size;
  }
  metrics["strain_of_bar"] = bar > 0 ? of_bar / bar : 0;
  for (size_t slice = 0; slice < kSlices; ++slice) {
    if (volume[slice] > 0)
      metrics["strain_of_neck"] =
          std::max(metrics["strain_of_neck"], strain[slice] / volume[slice]);
  }

  // Cross-sections, whose volume stays, from how far slices have stretched.
  const Frame& before = run.frames[run.separation > 0 ? static_cast<size_t>(run.separation) - 1
                                                      : run.frames.size() - 1];
  std::vector<double> rest(kSlices, 0), now(kSlices, 0), count(kSlices, 0);
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    const double x = mesh.rest_positions[node][0];
    rest[SliceOf(x)] += x;
    now[SliceOf(x)] += before.positions[node][0];
    count[SliceOf(x)] += 1;
  }
  metrics["neck_area"] = 1;
  metrics["neck_length"] = 0;
  for (size_t slice = 1; slice < kSlices; ++slice) {
    const double gap = rest[slice] / count[slice] - rest[slice - 1] / count[slice - 1];
    const double length = now[slice] / count[slice] - now[slice - 1] / count[slice - 1];
    metrics["neck_area"] = std::min(metrics["neck_area"], gap / length);
    if (gap / length < 0.75) metrics["neck_length"] += length;
  }
  for (const FrameReport& report : run.reports) metrics["solves"] += report.newton_iterations;
  return metrics;
}

std::vector<Criterion> DuctileBarCriteria() {
  // Nothing where a bar did not come to it: elongations are -1 then.
  const auto ratio = [](const std::string& variant, const std::string& metric) -> Value {
    return [=](const Trial& trial) {
      const double upper = trial.Get(variant, metric), lower = trial.Get("gold", metric);
      return upper > 0 && lower > 0 ? upper / lower : 0;
    };
  };
  const auto farther = [&](const std::string& variant) -> std::vector<Condition> {
    return {{"elongation at first fracture, over gold", ratio(variant, "elongation_at_fracture"),
             Relation::kAtLeast, 1.15},
            {"elongation at separation, over gold", ratio(variant, "elongation_at_separation"),
             Relation::kAtLeast, 1.15},
            {"plastic strain of the neck, over gold", ratio(variant, "strain_of_neck"),
             Relation::kAbove, 1},
            {"plastic strain of the bar, over gold", ratio(variant, "strain_of_bar"),
             Relation::kAbove, 1}};
  };
  const auto away = [&](const std::string& metric) -> Value {
    return
        [value = ratio("off", metric)](const Trial& trial) { return std::abs(value(trial) - 1); };
  };
  return {
      {"The alloy stretches farther before it breaks", {"gold", "alloy"}, farther("alloy")},
      {"Its neck is longer and thinner",
       {"gold", "alloy"},
       {{"smallest cross-section, over gold", ratio("alloy", "neck_area"), Relation::kBelow, 0.8},
        {"length of the neck beyond that of gold, m",
         Difference(Of("alloy", "neck_length"), Of("gold", "neck_length")), Relation::kAbove, 0}},
       false,
       kHalf},
      {"With the impurity off it stretches no farther",
       {"gold", "off"},
       farther("off"),
       true,
       kAll},
      {"With the impurity off it is gold",
       {"gold", "off"},
       {{"ratio of elongations at first fracture, from 1", away("elongation_at_fracture"),
         Relation::kAtMost, 0.02},
        {"ratio of elongations at separation, from 1", away("elongation_at_separation"),
         Relation::kAtMost, 0.02}},
       false,
       kAll},
  };
}

}  // namespace cleave
