#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/mesh/incidence.h"
#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kFar = 1e6;

TetMesh Column() { return KuhnBox({2, 2, 4}, {1, 1, 2}); }

// Pressed slowly from above between plates without friction: the same stress everywhere.
Scene PressedColumn() {
  Scene scene = TightScene(1e6, 0.3, 1e-6, 1);
  AddBoxSet(scene, "bottom", {-kFar, -kFar, -kFar}, {kFar, kFar, 1e-9});
  AddBoxSet(scene, "top", {-kFar, -kFar, 2 - 1e-9}, {kFar, kFar, kFar});
  AddBoxSet(scene, "x0", {-kFar, -kFar, -kFar}, {1e-9, kFar, kFar});
  AddBoxSet(scene, "y0", {-kFar, -kFar, -kFar}, {kFar, 1e-9, kFar});
  AddMotion(scene, "bottom", {false, false, true});
  AddMotion(scene, "x0", {true, false, false});
  AddMotion(scene, "y0", {false, true, false});
  AddMotion(scene, "top", {false, false, true}).keyframes = {{0, {0, 0, 0}, 0},
                                                             {100, {0, 0, -0.3}, 0}};
  return scene;
}

// N, the load on the top at the end of the last step before the first break; and how much it then
// grew a step.
struct Crush {
  double load = 0, growth = 0;
  bool broke = false;
};
Crush FirstBreak(const Scene& scene) {
  auto simulation = *Simulation::Create(scene, Column(), {});
  const StopFlag stop;
  Crush crush;
  while (simulation->frame() < 100) {
    const auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) return crush;
    crush.broke = report->broken_edges > 0;
    if (crush.broke) return crush;
    const double load = -report->motion_forces.back()[2];
    crush.growth = load - crush.load;
    crush.load = load;
  }
  return crush;
}

TEST(CompressiveStrength, ACrushedColumnBreaksAtItsStrengthTimesItsArea) {
  Scene scene = PressedColumn();
  scene.materials[0].compressive_strength = 8e4;
  for (const auto aggregation : {StressAggregation::kMean, StressAggregation::kMax}) {
    scene.fracture.aggregation = aggregation;
    const Crush crush = FirstBreak(scene);
    ASSERT_TRUE(crush.broke);
    EXPECT_LE(crush.load, 8e4);
    EXPECT_GT(crush.load + 1.01 * crush.growth, 8e4);
  }
}

TEST(CompressiveStrength, WithoutItNoCompressionBreaks) {
  Scene scene = PressedColumn();
  scene.materials[0].tensile_strength = 8e4;
  const Crush crush = FirstBreak(scene);
  EXPECT_FALSE(crush.broke);
  EXPECT_GT(crush.load, 1.5 * 8e4);
}

TEST(CompressiveStrength, WeakeningsAndImpuritiesCountForItToo) {
  Scene scene = PressedColumn();
  scene.materials[0].compressive_strength = 8e4;
  scene.weakenings = {{BoxSelector{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}}, 0.5}};
  Crush crush = FirstBreak(scene);
  EXPECT_LE(crush.load, 4e4);
  EXPECT_GT(crush.load + 1.01 * crush.growth, 4e4);
  scene.weakenings.clear();
  scene.impurities = Impurities{.potency = 100};
  crush = FirstBreak(scene);
  ASSERT_TRUE(crush.broke);
  // 1 - p of impure bonds is a tenth of that of pure ones.
  EXPECT_NEAR(crush.load, 0.1 * 8e4, 0.02 * 8e4);
}

TEST(CompressiveStrength, OfAnInterfaceIsThatOfTheWeakerSide) {
  TetMesh mesh = Column();
  mesh.tet_regions.resize(mesh.tets.size());
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    double height = 0;
    for (const int32_t node : mesh.tets[tet])
      height += mesh.rest_positions[static_cast<size_t>(node)][2] / 4;
    mesh.tet_regions[tet] = height < 1 ? 1 : 2;
  }
  Scene scene = PressedColumn();
  scene.materials[0].regions = {"1"};
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].regions = {"2"};
  scene.materials[1].compressive_strength = 8e4;
  auto simulation = *Simulation::Create(scene, mesh, {});
  const StopFlag stop;
  while (simulation->broken_edges().empty() && simulation->frame() < 100)
    ASSERT_TRUE(simulation->Advance(stop).ok());
  ASSERT_FALSE(simulation->broken_edges().empty());
  const Incidence incidence = BuildIncidence(mesh);
  for (const int32_t edge : simulation->broken_edges()) {
    const auto [a, b] = incidence.edges[static_cast<size_t>(edge)];
    EXPECT_GE(mesh.rest_positions[static_cast<size_t>(a)][2], 1);
    EXPECT_GE(mesh.rest_positions[static_cast<size_t>(b)][2], 1);
  }
}

}  // namespace
}  // namespace cleave
