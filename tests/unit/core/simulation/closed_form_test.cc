#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/mesh/procedural.h"
#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/simulation/run_frames.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kFar = 1e6;

TEST(ClosedForm, ABodyFallsAsItsStepsAddUp) {
  const TetMesh mesh = KuhnBox({3, 2, 2}, {1.5, 1, 1}, {100, 200, -50});
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  scene.gravity = Vec3{0, 0, -9.81};
  auto simulation = MustCreate(scene, mesh);
  const StopFlag stop;
  const int n = 30;
  for (int step = 0; step < n; ++step) {
    const auto report = simulation->Advance(stop);
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_NEAR(report->elastic_energy, 0, 1e-18);
  }
  const double drop = 9.81 * 1e-4 * n * (n + 1) / 2;
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    EXPECT_NEAR(simulation->positions()[node][0], mesh.rest_positions[node][0], 1e-12);
    EXPECT_NEAR(simulation->positions()[node][1], mesh.rest_positions[node][1], 1e-12);
    EXPECT_NEAR(simulation->positions()[node][2], mesh.rest_positions[node][2] - drop, 1e-12);
  }
}

// A row of the reference table: E = 1, nu = 0.3 at stretch l, lateral stretch and nominal stress.
struct Uniaxial {
  double stretch, lateral, nominal;
};
class UniaxialStretch : public ::testing::TestWithParam<Uniaxial> {};

TEST_P(UniaxialStretch, NarrowsAndPullsAsTheClosedForm) {
  const TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1});
  Scene scene = TightScene(1, 0.3, 1e-9, 1);
  AddSymmetryPlanes(scene);
  AddBoxSet(scene, "x1", {1 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  const auto [stretch, lateral, nominal] = GetParam();
  Motion& pull = AddMotion(scene, "x1", {true, false, false});
  pull.keyframes = {{0, {0, 0, 0}, 0}, {4, {stretch - 1, 0, 0}, 0}};
  auto simulation = MustCreate(scene, mesh);
  const StopFlag stop;
  FrameReport last;
  for (int step = 0; step < 10; ++step) {
    auto report = simulation->Advance(stop);
    ASSERT_TRUE(report.ok()) << report.status();
    last = *report;
  }
  EXPECT_NEAR(last.motion_forces.back()[0], nominal, 1e-9);
  EXPECT_NEAR(simulation->positions().back()[1], lateral, 1e-9);
  EXPECT_NEAR(simulation->positions().back()[2], lateral, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Reference, UniaxialStretch,
                         ::testing::Values(Uniaxial{0.5, 1.0954451150103321, -0.7307692307692306},
                                           Uniaxial{0.8, 1.0606601717798212, -0.2331730769230768},
                                           Uniaxial{0.9, 1.030402055055078, -0.10757623720586677},
                                           Uniaxial{1.01, 0.9970056138751766, 0.009931380769757123},
                                           Uniaxial{1.1, 0.9706434774573919, 0.09365427960469291},
                                           Uniaxial{1.25, 0.9295160030897801, 0.21492307692307688},
                                           Uniaxial{1.5, 0.8692269873603532, 0.3831908831908832},
                                           Uniaxial{2.0, 0.7745966692414834, 0.6538461538461537},
                                           Uniaxial{3.0, 0.6497862896539309, 1.0997150997150995}));

TEST(ClosedForm, APatchUnderAnAffineBoundaryIsAffineInside) {
  const TetMesh mesh = KuhnBox({4, 4, 4}, {1, 1, 1});
  Scene scene = TightScene(1e5, 0.3, 1e-6, 1);
  AddBoxSet(scene, "x0", {-kFar, -kFar, -kFar}, {1e-9, kFar, kFar});
  AddBoxSet(scene, "x1", {1 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  AddBoxSet(scene, "y0", {-kFar, -kFar, -kFar}, {kFar, 1e-9, kFar});
  AddBoxSet(scene, "y1", {-kFar, 1 - 1e-9, -kFar}, {kFar, kFar, kFar});
  AddBoxSet(scene, "z0", {-kFar, -kFar, -kFar}, {kFar, kFar, 1e-9});
  AddBoxSet(scene, "z1", {-kFar, -kFar, 1 - 1e-9}, {kFar, kFar, kFar});
  const double stretch[3] = {0.1, -0.05, 0.2};
  for (size_t axis = 0; axis < 3; ++axis) {
    std::array<bool, 3> axes = {axis == 0, axis == 1, axis == 2};
    AddMotion(scene, std::string(1, "xyz"[axis]) + "0", axes);
    Motion& pull = AddMotion(scene, std::string(1, "xyz"[axis]) + "1", axes);
    Vec3 shift = {0, 0, 0};
    shift[axis] = stretch[axis];
    pull.keyframes = {{0, {0, 0, 0}, 0}, {1, shift, 0}};
  }
  auto simulation = MustCreate(scene, mesh);
  const StopFlag stop;
  for (int step = 0; step < 3; ++step) ASSERT_TRUE(simulation->Advance(stop).ok());
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(simulation->positions()[node][axis],
                  mesh.rest_positions[node][axis] * (1 + stretch[axis]), 1e-12);
    }
  }
}

// Stretched, sheared and turned, and no two tets alike; every node of the boundary is given.
TEST(ClosedForm, AnIrregularPatchUnderAnyAffineBoundaryIsAffineInside) {
  BoxMesh box;
  box.size = {1, 1, 1};
  box.resolution.cell_size = 0.3;
  const TetMesh mesh = *BuildMesh(box);
  const double gradient[3][3] = {{1.1, 0.25, -0.1}, {0.05, 0.9, 0.2}, {-0.15, 0.1, 1.2}};
  const auto mapped = [&gradient](const Vec3& x) {
    Vec3 y{0, 0, 0};
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) y[i] += gradient[i][j] * x[j];
    return y;
  };
  for (const ElasticLaw law : {ElasticLaw::kStableNeoHookean, ElasticLaw::kInvertibleNeoHookean,
                               ElasticLaw::kCorotatedLinear, ElasticLaw::kStVenantKirchhoff}) {
    Scene scene = TightScene(1e5, 0.3, 1e-6, 1);
    scene.materials[0].law = law;
    scene.materials[0].fibres = {{2e5, ConstantDirection{{1, 2, 3}}, 1}};
    for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
      const Vec3& x = mesh.rest_positions[node];
      if (std::none_of(x.begin(), x.end(), [](double c) { return c < 1e-9 || c > 1 - 1e-9; }))
        continue;
      const Vec3 y = mapped(x);
      NodeSet& set = scene.node_sets.emplace_back();
      set.name = absl::StrCat("node ", node);
      set.select.push_back(IdSelector{{static_cast<int64_t>(node)}});
      AddMotion(scene, set.name).keyframes = {{0, {0, 0, 0}, 0},
                                              {1, {y[0] - x[0], y[1] - x[1], y[2] - x[2]}, 0}};
    }
    EXPECT_LT(scene.motions.size() + 10, mesh.rest_positions.size());
    auto simulation = MustCreate(scene, mesh);
    RunFrames(*simulation, 3);
    double farthest = 0;
    for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
      const Vec3 y = mapped(mesh.rest_positions[node]);
      for (size_t axis = 0; axis < 3; ++axis)
        farthest = std::max(farthest, std::abs(simulation->positions()[node][axis] - y[axis]));
    }
    EXPECT_LT(farthest, 1e-12) << static_cast<int>(law);
  }
}

TEST(ClosedForm, ARigidTurnCostsNothing) {
  const TetMesh mesh = KuhnBox({3, 2, 2}, {1.5, 1, 1});
  Scene scene = TightScene(1e5, 0.3, 1e-9, 1);
  scene.materials[0].tensile_strength = 1e-6;  // Pa: nothing may break, so there is no stress
  AddBoxSet(scene, "all", {-kFar, -kFar, -kFar}, {kFar, kFar, kFar});
  Motion& turn = AddMotion(scene, "all");
  turn.rotation_axis = {1, -2, 0.5};
  turn.rotation_center = {3, 4, 5};
  turn.keyframes = {{0, {0, 0, 0}, 0}, {10, {7, 8, 9}, 30}};
  auto simulation = MustCreate(scene, mesh);
  const StopFlag stop;
  for (int step = 0; step < 10; ++step) {
    const auto report = simulation->Advance(stop);
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_NEAR(report->elastic_energy, 0, 1e-12 * 1e5);
    EXPECT_EQ(report->broken_edges, 0);
    for (const double force : report->motion_forces[0]) EXPECT_NEAR(force, 0, 1e-12 * 1e5);
  }
}

// Of the stable Neo-Hookean solid, E = 1 MPa, nu = 0.3, at a uniaxial stretch, Pa.
double NominalStress(double stretch) {
  const double mu = 1e6 / 2.6, lambda = 1e6 * 0.3 / (1.3 * 0.4);
  const double volume_ratio = 1 + mu / (lambda + mu) * (1 - 1 / stretch);
  return mu * (stretch - volume_ratio / (stretch * stretch));
}

// Edges along the bar fail at their stress, which is the load over the rest area.
TEST(ClosedForm, ABarFirstBreaksAtItsStrengthTimesItsArea) {
  const double strength = 1e5;
  double low = 1, high = 1.2;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (NominalStress(middle) < strength ? low : high) = middle;
  }
  EXPECT_NEAR(low, 1.107255, 5e-7);
  const TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1});
  for (const StressAggregation aggregation : {StressAggregation::kMean, StressAggregation::kMax}) {
    Scene scene = TightScene(1e6, 0.3, 1e-6, 1);
    scene.materials[0].tensile_strength = strength;
    scene.fracture.aggregation = aggregation;
    AddSymmetryPlanes(scene);
    AddBoxSet(scene, "x1", {2 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
    // Just short of the stretch, at rest there, then just beyond.
    const double pull = 2 * (low - 1), hair = 1e-8;
    AddMotion(scene, "x1", {true, false, false}).keyframes = {{0, {0, 0, 0}, 0},
                                                              {10, {pull - hair, 0, 0}, 0},
                                                              {15, {pull - hair, 0, 0}, 0},
                                                              {16, {pull + hair, 0, 0}, 0}};
    auto simulation = MustCreate(scene, mesh);
    const StopFlag stop;
    for (int frame = 1; frame <= 16; ++frame) {
      const auto report = simulation->Advance(stop);
      ASSERT_TRUE(report.ok()) << report.status();
      EXPECT_EQ(report->broken_edges > 0, frame == 16) << "frame " << frame;
      if (frame != 15) continue;
      EXPECT_NEAR(report->motion_forces.back()[0], 1e5, 1e-2);
      EXPECT_LT(report->motion_forces.back()[0], 1e5);
    }
  }
}

}  // namespace
}  // namespace cleave
