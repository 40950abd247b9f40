#include "tests/scenes/steak.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/base/status.h"
#include "tests/metrics/pieces.h"
#include "tests/scenes/scene_parts.h"
#include "tests/scenes/shapes.h"

namespace cleave {
namespace {

constexpr Vec3 kSize{0.2, 0.12, 0.02};  // m
constexpr double kGrip = 0.02;          // m at each end
constexpr double kPull = 0.3;           // m
constexpr double kSeconds = 1.5;
constexpr int32_t kFat = 1;  // region

// The line that a fibre follows: a wave along x.
double Wave(double x) { return 0.006 * std::sin(2 * std::numbers::pi * x / 0.11); }
Vec3 FibreAt(const Vec3& x) {
  const double wave_number = 2 * std::numbers::pi / 0.11;
  const double slope = 0.006 * wave_number * std::cos(wave_number * x[0]);
  const double length = std::hypot(1, slope);
  return {1 / length, slope / length, 0};
}

// Streaks of fat lie between fibres.
bool InFat(const Vec3& x) {
  struct Streak {
    double middle, y, half_length, half_width;  // m
  };
  constexpr Streak kStreaks[] = {{-0.03, 0.022, 0.045, 0.0035},
                                 {0.035, -0.004, 0.04, 0.0035},
                                 {-0.02, -0.03, 0.035, 0.0035},
                                 {0.045, 0.036, 0.025, 0.003}};
  for (const Streak& streak : kStreaks) {
    const double along = (x[0] - streak.middle) / streak.half_length;
    const double across = (x[1] - Wave(x[0]) - streak.y) / streak.half_width;
    if (along * along + across * across <= 1) return true;
  }
  return false;
}

// Strands across the tear of the last frame: edges that hold there, drawn long, along the fibres.
double StrandCount(const TetMesh& mesh, const Incidence& incidence, const Frame& frame,
                   const Frame& last) {
  double count = 0;
  for (const int32_t edge : BridgingEdges(incidence, frame, last)) {
    if (EdgeStretch(mesh, incidence, frame, edge) < 1.3) continue;
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    const Vec3& p = mesh.rest_positions[static_cast<size_t>(a)];
    const Vec3& q = mesh.rest_positions[static_cast<size_t>(b)];
    const Vec3 fibre = FibreAt({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
    const double length = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    const double along =
        ((p[0] - q[0]) * fibre[0] + (p[1] - q[1]) * fibre[1] + (p[2] - q[2]) * fibre[2]) / length;
    count += std::abs(along) >= 0.8 ? 1 : 0;
  }
  return count;
}

}  // namespace

absl::StatusOr<Demonstration> MakeSteak(const Setting& setting) {
  Demonstration made;
  made.cell_size = 0.0063 * setting.coarseness;
  CLEAVE_ASSIGN_OR_RETURN(
      made.mesh, SuperellipseSlab(kSize, 4, {setting.layout, made.cell_size, 0.2, setting.seed}));
  made.mesh.regions.push_back({0, "meat"});
  NameRegion(made.mesh, kFat, "fat", InFat);
  for (size_t tet = 0; tet < made.mesh.tets.size(); ++tet)
    made.fibres.push_back(FibreAt(Centroid(made.mesh, tet)));
  made.rest_length = kSize[0] - 2 * kGrip;

  Scene& scene = made.scene;
  scene.name = "steak";
  scene.seed = setting.seed;
  Material meat;
  meat.name = "meat";
  meat.youngs_modulus = 1e5;
  meat.poisson_ratio = 0.4;
  meat.density = 1050;
  // Fails at a strain of 0.22, well before the stretch from which edges count as strands.
  meat.tensile_strength = 2.2e4;
  if (setting.variant != "iso") {
    FibreFamily family;
    family.stiffness = 1e6;
    TetDirections directions;
    for (const Vec3& fibre : made.fibres) {
      directions.vectors.push_back(setting.variant == "turned" ? Vec3{-fibre[1], fibre[0], 0}
                                                               : fibre);
    }
    family.direction = directions;
    family.strength_ratio = 3;
    meat.fibres.push_back(family);
  }
  meat.strands = Strands{0.1, 3};
  scene.materials.push_back(meat);
  Material fat;
  fat.name = "fat";
  fat.regions = {"fat"};
  fat.youngs_modulus = 2e4;
  fat.poisson_ratio = 0.4;
  fat.density = 920;
  fat.tensile_strength = 1e4;
  scene.materials.push_back(fat);
  Impurities flaws;
  flaws.noise = 0.1;
  scene.impurities = flaws;

  GripEnds(made, kSize[0], kGrip);
  AddMotion(scene, "left end");
  made.pull_direction = InPlane(30);
  const Vec3& way = made.pull_direction;
  made.pull_motion = AddMotion(scene, "right end", {true, true, true},
                               PullBy({kPull * way[0], kPull * way[1], 0}, kSeconds));
  Reinforce(scene, kSize[0] / 2 - 0.6 * kGrip, kGrip);
  SetPace(scene, kSeconds, 180);
  return made;
}

Metrics MeasureSteak(const Demonstration& demonstration, const Incidence& incidence,
                     const Run& run) {
  Metrics metrics;
  const TetMesh& mesh = demonstration.mesh;
  metrics["smallest_hold"] = SmallestHold(mesh, incidence, run.frames);
  metrics["half_open"] = -1;
  metrics["bridging"] = 0;
  const std::vector<double> parted = PartedShares(mesh, incidence, run.frames);
  if (parted.empty()) return metrics;
  // At rest nothing is broken, at the end all: there is a frame before the one that is past half.
  const auto past = std::lower_bound(parted.begin(), parted.end(), 0.5);
  const auto half = static_cast<size_t>(past - parted.begin());
  const auto strands = [&](size_t frame) {
    return StrandCount(mesh, incidence, run.frames[frame], run.frames.back());
  };
  metrics["half_open"] = static_cast<double>(half);
  metrics["bridging"] = std::lerp(strands(half - 1), strands(half),
                                  (0.5 - parted[half - 1]) / (parted[half] - parted[half - 1]));
  return metrics;
}

std::vector<Criterion> SteakCriteria() {
  const auto follows = [](const std::string& variant) -> std::vector<Condition> {
    return {{"A(a) over that without fibres",
             Ratio(Of(variant, "fibre_crossing"), Of("iso", "fibre_crossing")), Relation::kAtMost,
             0.7}};
  };
  // As many edges cross the tear as cells have room in it.
  const auto bridges = [](const std::string& variant) -> std::vector<Condition> {
    return {{"strands across the tear, as of cells of full size",
             [variant](const Trial& trial) {
               const double coarseness = trial.setting.coarseness;
               return trial.Get(variant, "bridging") * coarseness * coarseness;
             },
             Relation::kAtLeast, 20}};
  };
  return {
      {"It tears along its fibres", {"meat", "iso"}, follows("meat")},
      {"With fibres turned by 90 degrees it does not",
       {"turned", "iso"},
       follows("turned"),
       true,
       kAll},
      {"Strands bridge the tear", {"meat"}, bridges("meat")},
      {"With fibres along the tear none do", {"turned"}, bridges("turned"), true, kAll},
      {"Without fibres none do", {"iso"}, bridges("iso"), true, kAll},
      {"A piece dangles",
       {"meat"},
       {{"least of its boundary that a piece hangs by", Of("meat", "smallest_hold"),
         Relation::kAtMost, 0.1}}},
  };
}

}  // namespace cleave
