#include "tests/scenes/pizza.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "tests/metrics/pieces.h"
#include "tests/scenes/scene_parts.h"

namespace cleave {
namespace {

constexpr double kRadius = 0.15;      // m
constexpr double kThickness = 0.012;  // m
constexpr int kSlices = 8;
constexpr double kDepth = 0.6 * kThickness;  // m, of the cuts, and of the dough under the cheese
constexpr double kCheese = kDepth;           // m, its lower side
constexpr double kCrust = 0.88 * kRadius;    // m, where the cheese ends
constexpr double kLiftSeconds = 0.5;
constexpr double kFramesPerSecond = 50;
constexpr int32_t kCheeseRegion = 1;

// The bearing of the slice that is pulled, number 0.
constexpr double kSliceAngle = std::numbers::pi / kSlices;  // rad

double CutAngle(int cut) { return 2 * std::numbers::pi * cut / kSlices; }

double RadiusOf(const Vec3& x) { return std::hypot(x[0], x[1]); }

// From a place to the nearest of the first `cuts` cuts, seen from above, m. The first two are those
// beside the slice that is pulled.
double DistanceFromCuts(const Vec3& x, int cuts = kSlices) {
  double distance = RadiusOf(x);
  for (int cut = 0; cut < cuts; ++cut) {
    const double c = std::cos(CutAngle(cut)), s = std::sin(CutAngle(cut));
    if (c * x[0] + s * x[1] > 0) distance = std::min(distance, std::abs(c * x[1] - s * x[0]));
  }
  return distance;
}

// Which slice a place belongs to.
int SliceOf(const Vec3& x) {
  const double turn = std::atan2(x[1], x[0]) / (2 * std::numbers::pi);
  return static_cast<int>(std::floor((turn - std::floor(turn)) * kSlices)) % kSlices;
}

// What the wheel left in the dough before the cheese flowed together over it: eight radii from the
// rim to the middle, from below.
Strokes Cuts(double from, double to, double depth) {
  Strokes cuts;
  for (int cut = 0; cut < kSlices; ++cut) {
    const double c = std::cos(CutAngle(cut)), s = std::sin(CutAngle(cut));
    cuts.curves.push_back({{{from * c, from * s, 0}, {to * c, to * s, 0}}});
  }
  cuts.direction = {0, 0, 1};
  cuts.depth = depth;
  return cuts;
}

}  // namespace

absl::StatusOr<Demonstration> MakePizza(const Setting& setting) {
  const double cell_size = 0.0085 * setting.coarseness;
  DiscMesh disc;
  disc.radius = kRadius;
  disc.thickness = kThickness;
  disc.resolution = {setting.layout, cell_size, 0.2, setting.seed};
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, BuildMesh(disc));
  return MakePizzaOf(std::move(mesh), cell_size, {}, setting);
}

Demonstration MakePizzaOf(TetMesh mesh, double cell_size, const PizzaRecipe& recipe,
                          const Setting& setting) {
  Demonstration made;
  made.mesh = std::move(mesh);
  made.cell_size = cell_size;
  made.mesh.regions.push_back({0, "dough"});
  NameRegion(made.mesh, kCheeseRegion, "cheese",
             [](const Vec3& x) { return x[2] > kCheese && RadiusOf(x) < kCrust; });

  Scene& scene = made.scene;
  scene.name = "pizza";
  scene.seed = setting.seed;
  Material dough;
  dough.name = "dough";
  dough.youngs_modulus = 8e4;
  dough.poisson_ratio = 0.3;
  dough.density = 500;
  dough.tensile_strength = 5e4;
  scene.materials.push_back(dough);
  Material cheese;
  cheese.name = "cheese";
  cheese.regions = {"cheese"};
  cheese.youngs_modulus = 3e4;
  cheese.poisson_ratio = 0.4;
  cheese.density = 1000;
  cheese.tensile_strength = 3e4;
  cheese.plasticity = Plasticity{
      .yield_stress = 1e3, .hardening = 1e3, .failure_strain = recipe.cheese_failure_strain};
  scene.materials.push_back(cheese);
  if (setting.variant != "uncut") {
    ImpurityLayer layer;
    layer.name = "cuts";
    layer.source = Cuts(1.1 * kRadius, 0, kDepth);
    layer.weakening = 0.3;
    Impurities impurities;
    impurities.layers.push_back(layer);
    if (recipe.crust_depth) {
      layer.name = "cuts of the crust";
      layer.source = Cuts(1.1 * kRadius, kCrust, *recipe.crust_depth);
      impurities.layers.push_back(layer);
    }
    scene.impurities = impurities;
    if (setting.variant == "shuffled") DealOut(scene, MarkedNodes(scene, made.mesh), setting.seed);
  }

  // A hand takes the slice by its crust, away from the cuts, lifts it and pulls it out; what lies
  // beyond its neighbours is held.
  made.pulled = NodesWhere(made.mesh, [](const Vec3& x) {
    return SliceOf(x) == 0 && RadiusOf(x) > 0.6 * kRadius && DistanceFromCuts(x) > 0.025;
  });
  made.grip = NodesWhere(
      made.mesh, [](const Vec3& x) { return SliceOf(x) != 0 && DistanceFromCuts(x, 2) > 0.035; });
  AddNodeSet(scene, "rest", made.grip);
  AddNodeSet(scene, "slice", made.pulled);
  AddMotion(scene, "rest");
  const double c = std::cos(kSliceAngle), s = std::sin(kSliceAngle);
  made.pull_direction = {c, s, 0};
  Keyframe lifted;
  lifted.time = kLiftSeconds;
  lifted.rotation = 0.7;
  lifted.translation = {0.005 * c, 0.005 * s, 0};  // m
  Keyframe out = lifted;
  out.time = recipe.seconds;
  out.translation = {recipe.pull * c, recipe.pull * s, 0};
  made.pull_motion = AddMotion(scene, "slice", {true, true, true}, {Keyframe{}, lifted, out});
  scene.motions.back().rotation_axis = {s, -c, 0};
  SetPace(scene, recipe.seconds, std::lround(kFramesPerSecond * recipe.seconds));
  return made;
}

Metrics MeasurePizza(const Demonstration& demonstration, const Incidence& incidence,
                     const Run& run) {
  Metrics metrics;
  const TetMesh& mesh = demonstration.mesh;
  const std::vector<int32_t>& broken = run.frames.back().broken_edges;
  const auto ends = [&](int32_t edge) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    return std::array<Vec3, 2>{mesh.rest_positions[static_cast<size_t>(a)],
                               mesh.rest_positions[static_cast<size_t>(b)]};
  };
  const auto middle = [&](int32_t edge) {
    const auto [p, q] = ends(edge);
    return Vec3{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2};
  };
  double along = 0;
  for (const int32_t edge : broken)
    along += DistanceFromCuts(middle(edge)) <= 1.5 * demonstration.cell_size ? 1 : 0;
  metrics["along_cuts"] = broken.empty() ? 0 : along / static_cast<double>(broken.size());

  const Pieces pieces = PiecesOf(mesh, incidence, broken);
  metrics["slice_share"] = 0;
  if (run.separation >= 0) {
    std::vector<int32_t> held(static_cast<size_t>(pieces.count), 0);
    for (const int32_t node : demonstration.pulled) {
      const int32_t piece = pieces.node_pieces[static_cast<size_t>(node)];
      if (piece >= 0) ++held[static_cast<size_t>(piece)];
    }
    const auto most = std::max_element(held.begin(), held.end()) - held.begin();
    metrics["slice_share"] = pieces.shares[static_cast<size_t>(most)];
  }

  const int64_t half = CrackOpenTo(run.frames, 0.5);
  metrics["half_open"] = static_cast<double>(half);
  double strings = 0;
  if (half >= 0) {
    const Frame& frame = run.frames[static_cast<size_t>(half)];
    for (int32_t edge = 0; edge < incidence.edge_count(); ++edge) {
      const auto [p, q] = ends(edge);
      const Vec3 at = middle(edge);
      const bool across = SliceOf(p) != SliceOf(q);
      if (!across || at[2] < kCheese || RadiusOf(at) > kCrust) continue;
      if (std::binary_search(frame.broken_edges.begin(), frame.broken_edges.end(), edge)) continue;
      strings += EdgeStretch(mesh, incidence, frame, edge) >= 1.5 ? 1 : 0;
    }
  }
  metrics["strings"] = strings;
  return metrics;
}

std::vector<Criterion> PizzaCriteria() {
  return {
      {"The slice leaves along its cuts",
       {"cut"},
       {{"share of broken edges within 1.5 cells of a cut", Of("cut", "along_cuts"),
         Relation::kAtLeast, 0.85},
        {"pieces", Of("cut", "pieces"), Relation::kAtLeast, 2}}},
      // What crumbles beside the cuts of a coarse body is missing from its slice.
      {.text = "The slice is an eighth of the pizza",
       .variants = {"cut"},
       .conditions = {{"the slice's share of the volume", Of("cut", "slice_share"),
                       Relation::kAtLeast, 0.9 / kSlices},
                      {"the slice's share of the volume", Of("cut", "slice_share"),
                       Relation::kAtMost, 1.1 / kSlices}},
       .full_size = true},
      {.text = "Cheese pulls strings across the cut when half of it is open",
       .variants = {"cut"},
       .conditions = {{"edges of cheese across a cut stretched to 1.5", Of("cut", "strings"),
                       Relation::kAtLeast, 10}},
       .full_size = true},
      {"Uncut it breaks elsewhere",
       {"uncut"},
       {{"share of broken edges within 1.5 cells of where cuts would be", Of("uncut", "along_cuts"),
         Relation::kBelow, 0.45}}},
  };
}

}  // namespace cleave
