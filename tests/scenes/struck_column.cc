#include "tests/scenes/struck_column.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
// the cells between them.
constexpr int kRows = 4;
constexpr int kCellsARow = 4;
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

// From a place on the side to the nearest wall between two cells, m.
double DistanceFromWall(const std::vector<Seed>& seeds, const Vec3& x) {
  const double whole = 2 * std::numbers::pi * kRadius;
  const double around = std::atan2(x[1], x[0]) * kRadius;
  struct Offset {
    double around, height, squared;
    bool outermost;
  };
  std::vector<Offset> offsets;
  for (size_t k = 0; k < seeds.size(); ++k) {
    const double aside = std::remainder(seeds[k].around - around, whole);
    const double above = seeds[k].height - x[2];
    const size_t row = k / kCellsARow;
    offsets.push_back({aside, above, aside * aside + above * above, row == 0 || row + 1 == kRows});
  }
  const Offset nearest =
      *std::min_element(offsets.begin(), offsets.end(),
                        [](const Offset& a, const Offset& b) { return a.squared < b.squared; });
  double distance = whole;
  for (const Offset& other : offsets) {
    if (nearest.outermost && other.outermost) continue;  // no wall beyond the closed cells
    const double apart = std::hypot(other.around - nearest.around, other.height - nearest.height);
    if (apart > 0) distance = std::min(distance, (other.squared - nearest.squared) / (2 * apart));
  }
  return distance;
}

// Painted on the side and carried inward to the axis.
SurfacePaint PaintedWalls(const TetMesh& mesh, uint32_t seed, double half_width) {
  const std::vector<Seed> seeds = CellSeeds(seed);
  SurfacePaint paint;
  paint.shares = MapOf(
      NodeFlags(mesh, [&](const Vec3& x) { return DistanceFromWall(seeds, x) <= half_width; }));
  paint.depth = 2 * kRadius;
  return paint;
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
  porcelain.tensile_strength = 8e6;
  scene.materials.push_back(porcelain);

  ImpurityLayer layer;
  layer.potency = 10;
  if (setting.variant == "sheet") {
    layer.name = "sheet";
    layer.source = SheetStroke();
  } else {
    layer.name = "walls";
    layer.source = PaintedWalls(made.mesh, setting.seed, 0.6 * made.cell_size);
    layer.weakening = 0.1;
  }
  Impurities impurities;
  impurities.layers.push_back(layer);
  scene.impurities = impurities;
  made.in_map = ImpureNodes(scene, made.mesh);
  if (setting.variant == "plain") scene.impurities.reset();

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
  return {
      {"With a sheet of impurities it breaks in two along the sheet",
       {"sheet"},
       {{"pieces", Of("sheet", "pieces"), Relation::kAtMost, 2},
        {"pieces", Of("sheet", "pieces"), Relation::kAtLeast, 2},
        {"90th percentile of the crack's distance from the sheet, cells",
         Of("sheet", "crack_distance"), Relation::kAtMost, 1.5},
        {"plastic strain", Of("sheet", "plastic_strain"), Relation::kAtMost, 0}}},
      {"Painted with Voronoi cells it breaks into shards",
       {"voronoi"},
       {{"pieces", Of("voronoi", "pieces"), Relation::kAtLeast, 5},
        {"plastic strain", Of("voronoi", "plastic_strain"), Relation::kAtMost, 0}}},
      // Walls of coarse cells are too large a part of the body.
      {.text = "Painted with Voronoi cells it breaks along their walls",
       .variants = {"voronoi"},
       .conditions = {{"lift of the walls' edges", Of("voronoi", "lift"), Relation::kAtLeast, 5}},
       .full_size = true},
      {"Without a map it breaks elsewhere",
       {"plain"},
       {{"10th percentile of the crack's distance from the sheet, cells of full size",
         [](const Trial& trial) {
           return trial.Get("plain", "crack_nearest") * trial.setting.coarseness;
         },
         Relation::kAbove, 5}}},
      {"Without a map it breaks along the walls",
       {"plain"},
       {{"lift of the walls' edges", Of("plain", "lift"), Relation::kAtLeast, 5}},
       true},
  };
}

}  // namespace cleave
