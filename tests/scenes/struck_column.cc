#include "tests/scenes/struck_column.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "absl/strings/match.h"
#include "core/base/counter_rng.h"
#include "core/base/status.h"
#include "tests/metrics/crack_surface.h"
#include "tests/scenes/scene_parts.h"
#include "tests/scenes/shapes.h"

namespace cleave {
namespace {

constexpr double kRadius = 0.1;      // m, of the column
constexpr double kBallRadius = 0.1;  // m
constexpr double kStruckAt = 0.6;    // m, height
constexpr double kSeconds = 0.04;
constexpr int64_t kFrames = 40;

// The oblique sheet.
constexpr Vec3 kSheetPoint{0, 0, 0.42};                                  // m
constexpr Vec3 kSheetNormal{0.5735764363510461, 0, 0.8191520442889918};  // 35 degrees from upright

Strokes SheetStroke() {
  Strokes cut;
  // Along the sheet's line of steepest fall, led through the column along y.
  cut.curves.push_back({{{-0.2, 0, kSheetPoint[2] + 0.2 * kSheetNormal[0] / kSheetNormal[2]},
                         {0.2, 0, kSheetPoint[2] - 0.2 * kSheetNormal[0] / kSheetNormal[2]}}});
  cut.direction = {0, 1, 0};
  return cut;
}

// Voronoi cells on the unrolled side: rows of staggered seeds, of which the outermost only close
// those between them.
constexpr int kRows = 3;
constexpr int kCellsARow = 5;
constexpr double kRowHeight = 0.12;     // m
constexpr double kMiddleHeight = 0.58;  // m, of the rows

struct Seed {
  double around = 0;  // m along the circumference
  double height = 0;  // m
};

std::vector<Seed> CellSeeds(uint32_t seed) {
  const double step = 2 * std::numbers::pi * kRadius / kCellsARow;
  std::vector<Seed> seeds;
  for (int row = 0; row < kRows; ++row) {
    for (int k = 0; k < kCellsARow; ++k) {
      const auto id = static_cast<uint64_t>(row * kCellsARow + k);
      const double aside = UniformDraw(seed, RandomStream::kPocket, id, 0) - 0.5;
      const double above = UniformDraw(seed, RandomStream::kPocket, id, 1) - 0.5;
      seeds.push_back({(k + 0.5 * (row % 2) + 0.3 * aside) * step,
                       kMiddleHeight + (row - 0.5 * (kRows - 1) + 0.3 * above) * kRowHeight});
    }
  }
  return seeds;
}

// Where two cells meet on the unrolled side.
struct Wall {
  Seed from, to;
};

// All but those between two of the outermost.
std::vector<Wall> WallsBetween(const std::vector<Seed>& seeds) {
  const double whole = 2 * std::numbers::pi * kRadius;
  std::vector<Wall> walls;
  const auto outermost = [](size_t seed) {
    return seed < kCellsARow || seed >= (kRows - 1) * kCellsARow;
  };
  // What is nearer to b than to a has (x - middle).(b - a) > 0.
  const auto image = [&](size_t seed, int turns) {
    return Seed{seeds[seed].around + turns * whole, seeds[seed].height};
  };
  for (size_t i = 0; i < seeds.size(); ++i) {
    for (size_t j = i + 1; j < seeds.size(); ++j) {
      for (int turns = -1; turns <= 1 && !(outermost(i) && outermost(j)); ++turns) {
        const Seed a = seeds[i], b = image(j, turns);
        const Seed middle{(a.around + b.around) / 2, (a.height + b.height) / 2};
        const double apart = std::hypot(b.around - a.around, b.height - a.height);
        const Seed along{(a.height - b.height) / apart, (b.around - a.around) / apart};
        // The part of the line between the two that is nearer to them than to any other.
        double low = -whole, high = whole;
        for (size_t k = 0; k < seeds.size(); ++k) {
          for (int other = -1; other <= 1; ++other) {
            const Seed c = image(k, other);
            if (k == i && other == 0) continue;
            if (k == j && other == turns) continue;
            const double x = c.around - a.around, y = c.height - a.height;
            const double speed = along.around * x + along.height * y;
            const double reach = ((c.around + a.around) / 2 - middle.around) * x +
                                 ((c.height + a.height) / 2 - middle.height) * y;
            if (speed > 0) high = std::min(high, reach / speed);
            if (speed < 0) low = std::max(low, reach / speed);
            if (speed == 0 && reach < 0) high = low;
          }
        }
        if (high <= low) continue;
        const auto at = [&](double t) {
          return Seed{middle.around + t * along.around, middle.height + t * along.height};
        };
        walls.push_back({at(low), at(high)});
      }
    }
  }
  return walls;
}

// Drawn on the side and pushed inward to the axis.
Strokes WallStroke(const Wall& wall) {
  constexpr int kParts = 8;
  const auto outward = [](double around) -> Vec3 {
    return {std::cos(around / kRadius), std::sin(around / kRadius), 0};
  };
  Strokes stroke;
  Polyline& curve = stroke.curves.emplace_back();
  for (int part = 0; part <= kParts; ++part) {
    const double share = static_cast<double>(part) / kParts;
    const auto between = [share](double from, double to) { return from + share * (to - from); };
    Vec3 point = outward(between(wall.from.around, wall.to.around));
    for (double& coordinate : point) coordinate *= 1.1 * kRadius;
    point[2] = between(wall.from.height, wall.to.height);
    curve.points.push_back(point);
  }
  stroke.direction = outward((wall.from.around + wall.to.around) / 2);
  for (double& coordinate : stroke.direction) coordinate = -coordinate;
  stroke.depth = kRadius;
  return stroke;
}

}  // namespace

absl::StatusOr<Demonstration> MakeStruckColumn(const Setting& setting) {
  Demonstration made;
  made.cell_size = 0.027 * setting.coarseness;
  CLEAVE_ASSIGN_OR_RETURN(made.mesh, Column({setting.layout, made.cell_size, 0.2, setting.seed}));
  Scene& scene = made.scene;
  scene.name = "struck column";
  scene.seed = setting.seed;
  Material porcelain;
  porcelain.name = "porcelain";
  porcelain.youngs_modulus = 6e9;  // a tenth of the real one's
  porcelain.poisson_ratio = 0.2;
  porcelain.density = 2400;
  porcelain.tensile_strength = 1.1e7;
  scene.materials.push_back(porcelain);

  ImpurityLayer layer;
  layer.potency = 10;
  layer.weakening = 0.1;
  Impurities impurities;
  if (absl::StartsWith(setting.variant, "sheet")) {
    layer.name = "sheet";
    layer.source = SheetStroke();
    impurities.layers.push_back(layer);
  } else {
    layer.name = "walls";
    for (const Wall& wall : WallsBetween(CellSeeds(setting.seed))) {
      layer.source = WallStroke(wall);
      impurities.layers.push_back(layer);
    }
  }
  scene.impurities = impurities;
  made.in_map = MarkedNodes(scene, made.mesh);
  if (setting.variant == "plain") scene.impurities.reset();
  if (absl::EndsWith(setting.variant, "-shuffled"))
    DealOut(scene, MarkedNodes(scene, made.mesh), setting.seed);

  made.grip = NodesWhere(made.mesh, [](const Vec3& x) { return x[2] < 0.04; });
  AddNodeSet(scene, "foot", made.grip);
  AddMotion(scene, "foot");
  Collider ball;
  ball.name = "steel ball";
  ball.shape = SphereShape{{-kRadius - kBallRadius - 0.002, 0, kStruckAt}, kBallRadius};
  ball.body = RigidBody{.mass = std::nullopt, .density = 7850, .velocity = {5, 0, 0}};
  ball.friction = 0.3;
  ball.stiffness = 0.02;
  scene.colliders.push_back(ball);
  scene.contact = Contact{.stiffness = 5, .friction = 0.3};  // shards wedge each other apart
  scene.gravity = Vec3{0, 0, -9.81};
  SetPace(scene, kSeconds, kFrames);
  scene.timing.steps_per_frame = 4;
  return made;
}

Metrics MeasureStruckColumn(const Demonstration& demonstration, const Incidence& incidence,
                            const Run& run) {
  Metrics metrics;
  const auto crack = CrackOfPieces(demonstration.mesh, incidence, run.frames.back().broken_edges);
  if (!crack.empty()) {
    metrics["crack_distance"] =
        DistanceFromPlane(crack, kSheetPoint, kSheetNormal, 0.9) / demonstration.cell_size;
    metrics["crack_nearest"] =
        DistanceFromPlane(crack, kSheetPoint, kSheetNormal, 0.1) / demonstration.cell_size;
  }
  metrics["plastic_strain"] = 0;
  for (const double strain : run.plastic_strains)
    metrics["plastic_strain"] = std::max(metrics["plastic_strain"], strain);
  return metrics;
}

std::vector<Criterion> StruckColumnCriteria() {
  const auto along_sheet = [](const std::string& variant) -> std::vector<Condition> {
    return {{"pieces", Of(variant, "pieces"), Relation::kAtMost, 2},
            {"pieces", Of(variant, "pieces"), Relation::kAtLeast, 2},
            {"90th percentile of the crack's distance from the sheet, cells",
             Of(variant, "crack_distance"), Relation::kAtMost, 1.5},
            {"plastic strain", Of(variant, "plastic_strain"), Relation::kAtMost, 0}};
  };
  const auto at_walls = [](const std::string& variant) -> std::vector<Condition> {
    return {{"share of broken edges with both ends at walls", Of(variant, "band_share"),
             Relation::kAtLeast, 0.6}};
  };
  const auto along_walls = [](const std::string& variant) -> Condition {
    return {"lift of the walls' edges", Of(variant, "lift"), Relation::kAtLeast, 5};
  };
  return {
      {"With a sheet of impurities it breaks in two along the sheet",
       {"sheet"},
       along_sheet("sheet")},
      {"With Voronoi cells drawn on it most of what breaks lies at their walls",
       {"voronoi"},
       at_walls("voronoi")},
      // A shard of a coarse body is two cells thick and may hang on; and so much of the body lies
      // at walls that no lift is far above 5.
      {.text = "With Voronoi cells drawn on it it breaks into shards",
       .variants = {"voronoi"},
       .conditions = {{"pieces", Of("voronoi", "pieces"), Relation::kAtLeast, 5},
                      {"plastic strain", Of("voronoi", "plastic_strain"), Relation::kAtMost, 0}},
       .full_size = true},
      {.text = "With Voronoi cells drawn on it it breaks along their walls",
       .variants = {"voronoi"},
       .conditions = {along_walls("voronoi")},
       .full_size = true},
      {"Without a map it breaks elsewhere",
       {"plain"},
       {{"10th percentile of the crack's distance from the sheet, cells of full size",
         [](const Trial& trial) {
           return trial.Get("plain", "crack_nearest") * trial.setting.coarseness;
         },
         Relation::kAbove, 5}}},
      {"Without a map most of what breaks lies at the walls", {"plain"}, at_walls("plain"), true},
      {"Without a map it breaks along the walls", {"plain"}, {along_walls("plain")}, true},
      {"With the sheet's impurities dealt out to other nodes it breaks along the sheet",
       {"sheet-shuffled"},
       along_sheet("sheet-shuffled"),
       true,
       kAll},
      {.text = "With the walls' impurities dealt out to other nodes it breaks along the walls",
       .variants = {"voronoi-shuffled"},
       .conditions = {along_walls("voronoi-shuffled")},
       .control = true,
       .share = kAll,
       .full_size = true},
  };
}

}  // namespace cleave
