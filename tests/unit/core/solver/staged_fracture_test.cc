#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/damage/components.h"
#include "core/mesh/incidence.h"
#include "core/model/build_model.h"
#include "core/model/tet_batches.h"
#include "core/solver/stepper.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

using Edge = std::array<int32_t, 2>;

// The broken edges of the reference run of a bar of 6x2x2 cells, pulled apart end to end; values of
// the method note, section 11.
const std::vector<Edge>& ReferenceBreak() {
  static const std::vector<Edge> edges = {
      {18, 27}, {18, 28}, {18, 30}, {18, 31}, {19, 28}, {19, 29}, {19, 31}, {19, 32}, {20, 29},
      {20, 32}, {21, 30}, {21, 31}, {21, 33}, {21, 34}, {22, 31}, {22, 32}, {22, 34}, {22, 35},
      {23, 32}, {23, 35}, {24, 33}, {24, 34}, {25, 34}, {25, 35}, {26, 35}};
  return edges;
}

class PulledBar : public ::testing::Test {
 protected:
  PulledBar() : mesh_(KuhnBox({6, 2, 2}, {3, 1, 1})), incidence_(BuildIncidence(mesh_)) {}

  Model MakeModel(double dt, StressAggregation aggregation) {
    scene_ = TightScene(1e5, 0.3, 10, dt);
    scene_.quality.residual_tolerance = 1e-9;
    scene_.quality.step_tolerance = 1e-7;
    scene_.materials[0].tensile_strength = 3000;
    AddBoxSet(scene_, "held", {-1, -1, -1}, {1e-9, 2, 2});
    AddBoxSet(scene_, "pulled", {3 - 1e-9, -1, -1}, {4, 2, 2});
    AddMotion(scene_, "held");
    AddMotion(scene_, "pulled").keyframes = {{0, {0, 0, 0}, 0}, {10, {1.5, 0, 0}, 0}};
    Model model = *BuildModel(scene_, mesh_);
    FracturePart& part = *model.fracture;
    part.settings.aggregation = aggregation;
    part.edge_thresholds.clear();
    for (const auto& [a, b] : model.incidence->edges) {
      const double x = 0.5 * (model.mesh->rest_positions[static_cast<size_t>(a)][0] +
                              model.mesh->rest_positions[static_cast<size_t>(b)][0]);
      double threshold = std::abs(x - 1.25) < 0.3 ? 1500 : 3000;
      if (x < 0.45 || x > 2.55) threshold = std::numeric_limits<double>::infinity();
      part.edge_thresholds.push_back(threshold);
    }
    return model;
  }

  std::vector<Edge> Broken(const Stepper& stepper) const {
    std::vector<Edge> edges;
    for (const int32_t edge : stepper.breaking()->ClientBrokenEdges())
      edges.push_back(incidence_.edges[static_cast<size_t>(edge)]);
    return edges;
  }

  TetMesh mesh_;
  Incidence incidence_;
  Scene scene_;
};

TEST_F(PulledBar, BreaksStepByStepAsTheReference) {
  const Model model = MakeModel(0.004, StressAggregation::kMean);
  Stepper stepper(model);
  State state = InitialState(scene_, mesh_, model);
  const StopFlag stop;
  int32_t separation_step = 0;
  for (int32_t step = 1; step <= 80; ++step) {
    StepReport report;
    const int64_t before = stepper.breaking()->broken_edge_count();
    ASSERT_TRUE(stepper.Step(0.004 * (step - 1), 0.004 * step, stop, state, report).ok());
    const int64_t broken = stepper.breaking()->broken_edge_count() - before;
    EXPECT_EQ(report.break_passes, step == 71 ? 3 : step == 73 ? 2 : step == 74 ? 1 : 0);
    EXPECT_EQ(broken, step == 71 ? 9 : step == 73 ? 12 : step == 74 ? 4 : 0) << "step " << step;
    EXPECT_EQ(report.fracture_energy > 0, broken > 0);
    if (separation_step == 0 && stepper.breaking()->ComponentCount() == 2) separation_step = step;
  }
  EXPECT_EQ(separation_step, 74);
  EXPECT_EQ(Broken(stepper), ReferenceBreak());

  int dead = 0;
  double volumes[2] = {0, 0};  // of the pieces: a quarter of each tet a node
  std::vector<int32_t> piece;
  ASSERT_EQ(LabelComponents(*model.incidence, stepper.breaking()->fracture().edge_broken(), piece),
            2);
  const auto factors = stepper.breaking()->fracture().damage_factors();
  for (size_t tet = 0; tet < factors.size(); ++tet) {
    dead += factors[tet] == 0;
    for (const int32_t node : model.mesh->tets[tet])
      volumes[piece[static_cast<size_t>(node)]] +=
          RestVolume(*model.mesh, static_cast<int64_t>(tet)) / 4;
  }
  EXPECT_EQ(dead, 24);
  EXPECT_NEAR(std::max(volumes[0], volumes[1]), 1.75, 1e-12);
  EXPECT_NEAR(std::min(volumes[0], volumes[1]), 1.25, 1e-12);
}

TEST_F(PulledBar, BreaksTheSameForOtherStepsAndAggregations) {
  for (const double dt : {0.002, 0.004, 0.008}) {
    for (const auto aggregation : {StressAggregation::kMean, StressAggregation::kMax}) {
      const Model model = MakeModel(dt, aggregation);
      Stepper stepper(model);
      State state = InitialState(scene_, mesh_, model);
      const StopFlag stop;
      const int steps = static_cast<int>(std::lround(0.4 / dt));
      for (int step = 0; step < steps; ++step) {
        StepReport report;
        ASSERT_TRUE(stepper.Step(dt * step, dt * (step + 1), stop, state, report).ok());
      }
      EXPECT_EQ(Broken(stepper), ReferenceBreak()) << "dt " << dt;
    }
  }
}

// How a slab with fibres askew to the pull tears.
struct Tearing {
  int newton_iterations = 0;
  int break_passes = 0;
  std::vector<int32_t> broken_edges;
};

Tearing TearSlab(bool fibrous) {
  const TetMesh mesh = KuhnBox({30, 15, 2}, {1, 0.5, 0.05});
  Scene scene = TightScene(1e6, 0.35, 1000, 0.01);
  scene.quality.residual_tolerance = 1e-4;
  scene.quality.step_tolerance = 1e-4;
  scene.quality.linear_tolerance = 1e-3;
  scene.materials[0].tensile_strength = 1.5e5;
  scene.materials[0].fibres.push_back({4e6, ConstantDirection{{1, 1, 0}}, 3});
  AddBoxSet(scene, "held", {-1, -1, -1}, {0.1, 1, 1});
  AddBoxSet(scene, "pulled", {0.9, -1, -1}, {2, 1, 1});
  AddMotion(scene, "held");
  AddMotion(scene, "pulled").keyframes = {{0, {0, 0, 0}, 0}, {1, {0.4, 0, 0}, 0}};
  Model model = *BuildModel(scene, mesh);
  EXPECT_TRUE(model.fibrous);
  model.fibrous = fibrous;
  Stepper stepper(model);
  State state = InitialState(scene, mesh, model);
  Tearing tearing;
  const StopFlag stop;
  for (int step = 0; step < 100; ++step) {
    StepReport report;
    EXPECT_TRUE(stepper.Step(0.01 * step, 0.01 * (step + 1), stop, state, report).ok());
    tearing.newton_iterations += report.newton_iterations;
    tearing.break_passes += report.break_passes;
  }
  tearing.broken_edges = stepper.breaking()->ClientBrokenEdges();
  return tearing;
}

TEST(TornSlab, WithFibresSolvesThatBeginWithTheStiffnessThatHelpedBeforeTakeFewerIterations) {
  const Tearing with = TearSlab(true);
  const Tearing without = TearSlab(false);
  EXPECT_GT(with.break_passes, 0);
  EXPECT_EQ(with.break_passes, without.break_passes);
  EXPECT_EQ(with.broken_edges, without.broken_edges);
  EXPECT_LT(with.newton_iterations, without.newton_iterations);
}

}  // namespace
}  // namespace cleave
