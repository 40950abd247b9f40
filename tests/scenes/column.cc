#include "tests/scenes/column.h"

#include <cmath>

#include "core/base/status.h"
#include "tests/metrics/crack_surface.h"
#include "tests/scenes/scene_parts.h"
#include "tests/scenes/shapes.h"

namespace cleave {
namespace {

constexpr Vec3 kSheetPoint{0, 0, 0.5};                                    // m
constexpr Vec3 kSheetNormal{-0.5735764363510461, 0, 0.8191520442889918};  // 35 degrees from upright

double DistanceFromSheet(const Vec3& x) {
  double distance = 0;
  for (size_t axis = 0; axis < 3; ++axis)
    distance += (x[axis] - kSheetPoint[axis]) * kSheetNormal[axis];
  return std::abs(distance);
}

}  // namespace

absl::StatusOr<Demonstration> MakeColumn(const Setting& setting) {
  Demonstration made;
  made.cell_size = 0.0205 * setting.coarseness;
  CLEAVE_ASSIGN_OR_RETURN(made.mesh, Column({setting.layout, made.cell_size, 0.2, setting.seed}));
  made.rest_length = 1;
  Scene& scene = made.scene;
  scene.name = "porcelain column";
  scene.seed = setting.seed;
  Material porcelain;
  porcelain.name = "porcelain";
  porcelain.youngs_modulus = 6e8;
  porcelain.poisson_ratio = 0.2;
  porcelain.density = 2400;
  porcelain.tensile_strength = 2e7;
  scene.materials.push_back(porcelain);
  if (setting.variant == "sheet") {
    made.in_map = NodeFlags(
        made.mesh, [&](const Vec3& x) { return DistanceFromSheet(x) <= 0.8 * made.cell_size; });
    Impurities impurities;
    impurities.potency = 10;
    impurities.map = MapOf(made.in_map);
    scene.impurities = impurities;
  }
  made.grip = NodesWhere(made.mesh, [](const Vec3& x) { return x[2] < 0.06; });
  made.pulled = NodesWhere(made.mesh, [](const Vec3& x) { return x[2] > 0.94; });
  AddNodeSet(scene, "base", made.grip);
  AddNodeSet(scene, "capital", made.pulled);
  AddMotion(scene, "base");
  made.pull_direction = {0, 0, 1};
  // So far aside that what has no sheet breaks at an end, where it is bent most: a shaft that is
  // merely stretched breaks anywhere, by its mesh, and now and then beside the place of the sheet.
  made.pull_motion = AddMotion(scene, "capital", {true, true, true}, PullBy({0.03, 0, 0.06}, 0.12));
  SetPace(scene, 0.12, 24);
  made.frames_after_separation = 4;
  return made;
}

Metrics MeasureColumn(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run) {
  Metrics metrics;
  const auto crack = CrackOfPieces(demonstration.mesh, incidence, run.frames.back().broken_edges);
  if (!crack.empty()) {
    metrics["crack_distance"] =
        DistanceFromPlane(crack, kSheetPoint, kSheetNormal, 0.9) / demonstration.cell_size;
  }
  metrics["unknowns_first"] = 3 * static_cast<double>(run.frames.front().positions.size());
  metrics["unknowns_last"] = 3 * static_cast<double>(run.frames.back().positions.size());
  const auto frames = static_cast<double>(run.reports.size());
  for (const FrameReport& report : run.reports) {
    metrics["assembly_seconds"] += report.assembly_seconds / frames;
    metrics["linear_solve_seconds"] += report.linear_solve_seconds / frames;
    metrics["fracture_seconds"] += report.fracture_seconds / frames;
    metrics["solves"] += report.newton_iterations / frames;
  }
  return metrics;
}

std::vector<Criterion> ColumnCriteria() {
  return {
      {"It breaks in two along its sheet",
       {"sheet"},
       {{"pieces", Of("sheet", "pieces"), Relation::kAtMost, 2},
        {"pieces", Of("sheet", "pieces"), Relation::kAtLeast, 2},
        {"90th percentile of the crack's distance from the sheet, cells",
         Of("sheet", "crack_distance"), Relation::kAtMost, 1.5},
        {"lift of the sheet's edges", Of("sheet", "lift"), Relation::kAtLeast, 5}}},
      {"Breaking adds no unknowns",
       {"sheet"},
       {{"unknowns, last frame over first",
         Ratio(Of("sheet", "unknowns_last"), Of("sheet", "unknowns_first")), Relation::kAtMost, 1},
        {"unknowns, last frame over first",
         Ratio(Of("sheet", "unknowns_last"), Of("sheet", "unknowns_first")), Relation::kAtLeast,
         1}},
       false,
       kAll},
      {"Without a map it breaks elsewhere",
       {"plain"},
       {{"90th percentile of the crack's distance from the sheet, cells of full size",
         [](const Trial& trial) {
           return trial.Get("plain", "crack_distance") * trial.setting.coarseness;
         },
         Relation::kAbove, 5}}},
  };
}

}  // namespace cleave
