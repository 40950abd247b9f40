#include "core/solver/stepper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/model/build_model.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

const double kPi = std::acos(-1.0);

// A bar that can only move along itself, held at both ends, in its lowest mode: amplitude, as a
// share of the start, after one period in `steps` steps.
double AmplitudeAfterAPeriod(int steps, double* phase_error) {
  const int cells = 40;
  const double youngs_modulus = 1e6, density = 1000;
  const double period = 2 / std::sqrt(youngs_modulus / density);
  const double dt = period / steps;
  const TetMesh mesh = KuhnBox({cells, 1, 1}, {1, 1.0 / cells, 1.0 / cells});
  Scene scene = TightScene(youngs_modulus, 0, density, dt);
  AddBoxSet(scene, "all", {-1, -1, -1}, {2, 2, 2});
  AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(scene, "right", {1 - 1e-9, -1, -1}, {2, 2, 2});
  AddMotion(scene, "all", {false, true, true});
  AddMotion(scene, "left", {true, false, false});
  AddMotion(scene, "right", {true, false, false});
  const Model model = *BuildModel(scene, mesh);
  State state = InitialState(scene, mesh, model);
  const auto mode = [&](size_t node) {
    return std::sin(kPi * model.mesh->rest_positions[node][0]);
  };
  for (size_t node = 0; node < state.displacements.size(); ++node)
    state.displacements[node][0] = 1e-6 * mode(node);
  const auto amplitude = [&] {
    double sum = 0, squares = 0;
    for (size_t node = 0; node < state.displacements.size(); ++node) {
      sum += model.masses[node] * mode(node) * state.displacements[node][0];
      squares += model.masses[node] * mode(node) * mode(node);
    }
    return sum / squares / 1e-6;
  };
  Stepper stepper(model);
  const StopFlag stop;
  double before = 0, after = 0;
  int crossing = 0;
  for (int step = 1; step <= steps; ++step) {
    StepReport report;
    const double previous = amplitude();
    EXPECT_TRUE(stepper.Step(dt * (step - 1), dt * step, stop, state, report).ok());
    // The third quarter ends where the amplitude crosses 0 upwards.
    if (previous < 0 && amplitude() >= 0) {
      before = previous;
      after = amplitude();
      crossing = step;
    }
  }
  const double crossing_time = dt * (crossing - after / (after - before));
  *phase_error = crossing_time / (0.75 * period) - 1;
  return amplitude();
}

TEST(Stepper, AStandingWaveKeepsItsPeriodAndLosesWhatBackwardEulerTakes) {
  double phase_error = 0;
  EXPECT_NEAR(AmplitudeAfterAPeriod(100, &phase_error), 0.821, 0.001);
  EXPECT_NEAR(phase_error, 0, 0.002);
  EXPECT_NEAR(AmplitudeAfterAPeriod(400, &phase_error), 0.952, 0.001);
  EXPECT_NEAR(phase_error, 0, 0.0005);
}

class Cantilever : public ::testing::TestWithParam<std::pair<int, double>> {};

// Weightless but for its end, where the load hangs as weight.
TEST_P(Cantilever, BendsAsTheReferenceTable) {
  const auto [n, tip] = GetParam();
  const TetMesh mesh = KuhnBox({8 * n, n, n}, {8, 1, 1});
  Scene scene = TightScene(1e6, 0, 1e-9, 10);
  scene.quality.residual_tolerance = 1e-8;
  scene.quality.step_tolerance = 1e-6;
  scene.gravity = Vec3{0, 0, -1};
  AddBoxSet(scene, "wall", {-1, -1, -1}, {1e-9, 2, 2});
  AddMotion(scene, "wall");
  Model model = *BuildModel(scene, mesh);
  // Unit load over the end face, to each node its share of the face's triangles.
  const double load = 1e-3;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    for (const auto& face : kTetFaces) {
      bool at_end = true;
      for (const int corner : face) {
        const int32_t node = mesh.tets[static_cast<size_t>(tet)][static_cast<size_t>(corner)];
        at_end = at_end && mesh.rest_positions[static_cast<size_t>(node)][0] > 8 - 1e-9;
      }
      if (!at_end) continue;
      for (const int corner : face) {
        const int32_t node = mesh.tets[static_cast<size_t>(tet)][static_cast<size_t>(corner)];
        model.masses[static_cast<size_t>(model.order.new_node[static_cast<size_t>(node)])] +=
            load / (6.0 * n * n);
      }
    }
  }
  Stepper stepper(model);
  State state = InitialState(scene, mesh, model);
  const StopFlag stop;
  for (int step = 0; step < 4; ++step) {
    StepReport report;
    ASSERT_TRUE(stepper.Step(10 * step, 10 * (step + 1), stop, state, report).ok());
  }
  double sum = 0;
  int count = 0;
  for (size_t node = 0; node < state.displacements.size(); ++node) {
    if (model.mesh->rest_positions[node][0] < 8 - 1e-9) continue;
    sum += state.displacements[node][2];
    ++count;
  }
  EXPECT_NEAR(sum / count / load / tip, 1, 0.002);
}

INSTANTIATE_TEST_SUITE_P(CellsAcross, Cantilever,
                         ::testing::Values(std::pair{1, -0.0005073552108764555},
                                           std::pair{2, -0.0011377043233467181},
                                           std::pair{4, -0.001704417280292223}));

TEST(Stepper, AFreeBodyKeepsItsMomentumWhileItDeforms) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1});
  Scene scene = TightScene(1e4, 0.3, 100, 0.005);
  InitialVelocity spin;
  spin.velocity = {1, 2, 3};
  spin.angular_velocity = {0, 5, 9};
  scene.initial_velocities.push_back(spin);
  const Model model = *BuildModel(scene, mesh);
  State state = InitialState(scene, mesh, model);
  const auto momentum = [&] {
    Double4 sum = Splat(0);
    for (size_t node = 0; node < state.velocities.size(); ++node)
      sum += model.masses[node] * state.velocities[node];
    return sum;
  };
  const Double4 before = momentum();
  Stepper stepper(model);
  const StopFlag stop;
  for (int step = 0; step < 20; ++step) {
    StepReport report;
    ASSERT_TRUE(stepper.Step(0.005 * step, 0.005 * (step + 1), stop, state, report).ok());
  }
  const Double4 after = momentum();
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(after[axis], before[axis], 1e-9 * std::sqrt(Dot(before, before)));
}

TEST(Stepper, AStepThatDoesNotConvergeIsHalved) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1});
  Scene scene = TightScene(1e5, 0.3, 1000, 0.1);
  scene.quality.newton_iterations = 3;
  scene.quality.residual_tolerance = 1e-4;
  scene.quality.step_tolerance = 1e-3;
  scene.quality.max_step_halvings = 8;
  AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(scene, "right", {2 - 1e-9, -1, -1}, {3, 2, 2});
  AddMotion(scene, "left");
  AddMotion(scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {0.1, {1, 0.5, 0}, 0}};
  const Model model = *BuildModel(scene, mesh);
  State state = InitialState(scene, mesh, model);
  Stepper stepper(model);
  const StopFlag stop;
  StepReport report;
  const absl::Status status = stepper.Step(0, 0.1, stop, state, report);
  ASSERT_TRUE(status.ok()) << status;
  EXPECT_GT(report.step_halvings, 0);
  EXPECT_EQ(report.steps, report.step_halvings + 1);
  for (const FixedNode& fixed : stepper.solver().fixed_nodes()) {
    const auto node = static_cast<size_t>(fixed.node);
    const double wanted = model.mesh->rest_positions[node][0] > 1 ? 1 : 0;
    EXPECT_DOUBLE_EQ(state.displacements[node][0], wanted);
  }
}

}  // namespace
}  // namespace cleave
