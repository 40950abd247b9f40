#include "tests/scenes/tube.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "tests/metrics/crack_surface.h"
#include "tests/metrics/statistics.h"
#include "tests/scenes/scene_parts.h"

namespace cleave {
namespace {

constexpr double kOuter = 0.5;   // m
constexpr double kInner = 0.35;  // m
constexpr double kRing = 0.2;    // of the length, in the middle
constexpr double kGrip = 0.1;    // m at each end
// Either end at 2 m/s: two fifths of what would break the end at once, as a wave from one end does
// when it has been reflected at the other. Both ends then see it at the same time, and neither
// crack unloads the other; hinged at one end, it broke in one place or two as its speed had it.
constexpr double kSpeed = 2;       // m/s
constexpr double kSeconds = 0.15;  // 4 times what a wave takes from end to end
constexpr int64_t kFrames = 150;   // steps of 1 ms follow the wave
// A ring of half the strength is the most that the first wave passes without breaking its edge.
constexpr std::array<double, 5> kPotencies = {0.02, 0.06, 0.12, 0.25, 0.5};

}  // namespace

absl::StatusOr<Demonstration> MakeTubeOf(const Setting& setting, double cell_size,
                                         const Impurities& impurities, uint32_t seed) {
  Demonstration made;
  made.cell_size = cell_size * setting.coarseness;
  TubeMesh tube;
  tube.outer_radius = kOuter;
  tube.inner_radius = kInner;
  tube.height = kTubeLength;
  tube.resolution = {setting.layout, made.cell_size, 0.2, setting.seed};
  CLEAVE_ASSIGN_OR_RETURN(made.mesh, BuildMesh(tube));
  // From along z to along x.
  for (Vec3& x : made.mesh.rest_positions) x = {x[2] - kTubeLength / 2, x[0], x[1]};
  made.rest_length = kTubeLength - 2 * kGrip;
  made.in_map =
      NodeFlags(made.mesh, [](const Vec3& x) { return std::abs(x[0]) <= kRing * kTubeLength / 2; });

  Scene& scene = made.scene;
  scene.name = "tube";
  scene.seed = seed;
  Material brittle;
  brittle.name = "brittle";
  brittle.youngs_modulus = 1e7;
  brittle.poisson_ratio = 0.3;
  brittle.density = 1000;
  brittle.tensile_strength = 5e5;
  scene.materials.push_back(brittle);
  scene.impurities = impurities;
  scene.impurities->map = MapOf(made.in_map);
  GripEnds(made, kTubeLength, kGrip);
  const double pull = kSpeed * kSeconds;
  AddMotion(scene, "left end", {true, true, true}, PullBy({-pull, 0, 0}, kSeconds));
  made.pull_motion =
      AddMotion(scene, "right end", {true, true, true}, PullBy({pull, 0, 0}, kSeconds));
  Reinforce(scene, kTubeLength / 2, 0.3);
  SetPace(scene, kSeconds, kFrames);
  made.frames_after_separation = 40;
  return made;
}

absl::StatusOr<Demonstration> MakeTube(const Setting& setting) {
  Impurities impurities;
  impurities.noise = 0.05;
  const std::string& variant = setting.variant;
  if (variant == "pure") {
    impurities.potency = 0;
  } else {
    const size_t level = variant == "shuffled" ? 5 : static_cast<size_t>(variant[0] - '0');
    impurities.potency = kPotencies[level - 1];
  }
  CLEAVE_ASSIGN_OR_RETURN(Demonstration made, MakeTubeOf(setting, 0.13, impurities, setting.seed));
  if (variant == "shuffled")
    made.scene.impurities->map = MapOf(Shuffled(made.in_map, setting.seed));
  return made;
}

Metrics MeasureTube(const Demonstration& demonstration, const Incidence& incidence,
                    const Run& run) {
  Metrics metrics;
  const auto crack = CrackOfPieces(demonstration.mesh, incidence, run.frames.back().broken_edges);
  std::vector<std::pair<double, double>> places;  // along the tube, area
  for (const CrackFacet& facet : crack) places.emplace_back(facet.center[0], facet.area);
  std::sort(places.begin(), places.end());
  const double least = 0.1 * CrackArea(crack);
  double area = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    area += places[i].second;
    if (i + 1 < places.size() && places[i + 1].first - places[i].first <= 0.1 * kTubeLength)
      continue;
    if (area >= least) metrics["break_sites"] += 1;
    area = 0;
  }
  return metrics;
}

std::vector<Criterion> TubeCriteria() {
  const auto in_ring = [](const std::string& variant) -> Condition {
    return {"share of broken edges that lie in the ring", Of(variant, "band_share"),
            Relation::kAtLeast, 0.9};
  };
  const auto one_site = [](const std::string& variant) -> Condition {
    return {"places along the tube where it breaks", Of(variant, "break_sites"), Relation::kAtMost,
            1};
  };
  return {
      {"At the highest potency it breaks in the ring and nowhere else",
       {"5"},
       {in_ring("5"), one_site("5")}},
      {"At the lowest it breaks in many places",
       {"1"},
       {{"share of broken edges that lie in the ring", Of("1", "band_share"), Relation::kAtMost,
         0.6},
        {"places along the tube where it breaks", Of("1", "break_sites"), Relation::kAtLeast, 2}}},
      {"The higher the potency, the more of it breaks in the ring",
       {"1", "2", "3", "4", "5"},
       {{"rank correlation of potency and share in the ring",
         [](const Trial& trial) {
           std::vector<double> shares;
           for (const char* variant : {"1", "2", "3", "4", "5"})
             shares.push_back(trial.Get(variant, "band_share"));
           return Spearman(kPotencies, shares);
         },
         Relation::kAtLeast, 0.9}}},
      {"Dealt out to other nodes, the same potencies do not lead it",
       {"shuffled"},
       {in_ring("shuffled"), one_site("shuffled")},
       true,
       kAll},
      {"Without a ring it breaks elsewhere", {"pure"}, {in_ring("pure"), one_site("pure")}, true},
  };
}

}  // namespace cleave
