#include "core/solver/rayleigh_damping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "core/model/build_model.h"
#include "core/model/footprint.h"
#include "core/solver/stepper.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

// A body on its way.
class MovingBody {
 public:
  MovingBody(const Scene& scene, const TetMesh& mesh)
      : dt_(1 / scene.timing.frames_per_second),
        model_(*BuildModel(scene, mesh)),
        stepper_(model_),
        state(InitialState(scene, mesh, model_)) {}

  void Step() {
    const absl::Status status =
        stepper_.Step(dt_ * count_, dt_ * (count_ + 1), StopFlag{}, state, report);
    ASSERT_TRUE(status.ok()) << status;
    ++count_;
  }
  void Steps(int count) {
    for (int step = 0; step < count; ++step) Step();
  }
  Double4 Momentum() const {
    Double4 sum = Splat(0);
    for (size_t node = 0; node < state.velocities.size(); ++node)
      sum += model_.masses[node] * state.velocities[node];
    return sum;
  }
  // About the z axis, kg m^2/s.
  double Spin() const {
    double sum = 0;
    for (size_t node = 0; node < state.velocities.size(); ++node) {
      const Double4 at = ToDouble4(model_.mesh->rest_positions[node]) + state.displacements[node];
      const Double4 v = state.velocities[node];
      sum += model_.masses[node] * (at[0] * v[1] - at[1] * v[0]);
    }
    return sum;
  }
  double elastic_energy() const { return stepper_.elastic_energy(); }
  const Model& model() const { return model_; }

 private:
  double dt_;
  Model model_;
  Stepper stepper_;
  int count_ = 0;

 public:
  State state;
  StepReport report;
};

TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

// A tet whose tip moves up and down over a fixed base is an oscillator of one coordinate: backward
// Euler takes a small amplitude u from step to step by
//   u'' (1 + c dt + w^2 dt^2) = u' (2 + c dt) - u,   c = a + b w^2.
TEST(RayleighDamping, AnOscillationDecaysAtTheRateOfItsCoefficients) {
  const double dt = 0.005, lambda = 4e5, mu = 4e5, density = 1000;
  const double omega_squared = 4 * (lambda + 2 * mu) / density;
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    for (const Damping damping :
         {Damping{0, 0}, Damping{20, 0}, Damping{0, 0.01}, Damping{7, 0.1}}) {
      SCOPED_TRACE(testing::Message() << damping.mass_coefficient << " 1/s, "
                                      << damping.stiffness_coefficient << " s");
      Scene scene = TightScene(1e6, 0.25, density, dt);
      scene.quality.precision = precision;
      scene.damping = damping;
      AddBoxSet(scene, "base", {-1, -1, -1}, {2, 2, 0.5});
      AddBoxSet(scene, "tip", {-1, -1, 0.5}, {2, 2, 2});
      AddMotion(scene, "base");
      AddMotion(scene, "tip", {true, true, false});
      MovingBody run(scene, OneTet());
      size_t tip = 0;
      while (run.model().mesh->rest_positions[tip][2] < 0.5) ++tip;
      const double start = 1e-6;
      run.state.displacements[tip][2] = start;
      const double rate = damping.mass_coefficient + damping.stiffness_coefficient * omega_squared;
      const double loss = 1 + rate * dt + omega_squared * dt * dt;
      std::vector<double> heights = {start, start};
      for (int step = 1; step <= 40; ++step) {
        ASSERT_NO_FATAL_FAILURE(run.Step());
        const size_t n = heights.size();
        const double expected = (heights[n - 1] * (2 + rate * dt) - heights[n - 2]) / loss;
        heights.push_back(run.state.displacements[tip][2]);
        ASSERT_NEAR(heights[n], expected, 1e-6 * start) << "step " << step;
      }
      // The squared amplitude of what oscillates, but for a factor: it falls by `loss` a step.
      const auto size = [&](size_t n) {
        return heights[n] * heights[n] - heights[n - 1] * heights[n + 1];
      };
      EXPECT_NEAR(std::log(size(2) / size(12)) / std::log(loss), 10, 0.01);
      EXPECT_EQ(run.report.damping_dissipation > 0, rate > 0);
    }
  }
}

// A stiff body of a fine mesh that flies fast: the roundings of its stiffness would drag it.
TEST(RayleighDamping, StiffnessDampingLeavesFlightAlone) {
  const TetMesh mesh = KuhnBox({4, 3, 3}, {0.04, 0.03, 0.03});
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Scene scene = TightScene(1e9, 0.3, 1000, 0.001);
    scene.quality.precision = precision;
    scene.gravity = Vec3{0, 0, -10};
    scene.initial_velocities.emplace_back().velocity = {30, -20, 10};
    MovingBody free(scene, mesh);
    scene.damping = Damping{0, 0.1};
    MovingBody damped(scene, mesh);
    ASSERT_NO_FATAL_FAILURE(free.Steps(10));
    ASSERT_NO_FATAL_FAILURE(damped.Steps(10));
    for (size_t node = 0; node < free.state.velocities.size(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(damped.state.velocities[node][axis], free.state.velocities[node][axis], 1e-9);
      }
    }
    EXPECT_NEAR(damped.report.damping_dissipation, 0,
                1e-12 * KineticEnergy(damped.model(), damped.state));
  }
}

TEST(RayleighDamping, MassDampingSlowsAFlightByAFactorAStep) {
  const TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1});
  Scene scene = TightScene(1e5, 0.3, 1000, 0.01);
  scene.initial_velocities.emplace_back().velocity = {3, 0, -4};
  scene.damping = Damping{5, 0};
  MovingBody run(scene, mesh);
  const double energy = KineticEnergy(run.model(), run.state);
  ASSERT_NO_FATAL_FAILURE(run.Steps(20));
  const double factor = std::pow(1 + 5 * 0.01, -20);
  for (const Double4& velocity : run.state.velocities) {
    EXPECT_NEAR(velocity[0], 3 * factor, 1e-9);
    EXPECT_NEAR(velocity[2], -4 * factor, 1e-9);
  }
  EXPECT_NEAR(run.report.damping_dissipation + run.report.integration_dissipation,
              energy * (1 - factor * factor), 1e-6 * energy);
}

TEST(RayleighDamping, StiffnessDampingKeepsMomentumWhileTheBodyDeforms) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1});
  Scene scene = TightScene(1e4, 0.3, 100, 0.005);
  AddBoxSet(scene, "half", {-1, -1, -1}, {1, 2, 2});
  scene.initial_velocities.emplace_back().velocity = {1, 2, 3};
  InitialVelocity kick;
  kick.node_set = "half";
  kick.velocity = {1, 0, -1};
  scene.initial_velocities.push_back(kick);
  scene.damping = Damping{0, 0.05};
  MovingBody run(scene, mesh);
  const Double4 before = run.Momentum();
  ASSERT_NO_FATAL_FAILURE(run.Steps(20));
  EXPECT_GT(run.report.damping_dissipation, 0);
  const Double4 after = run.Momentum();
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(after[axis], before[axis], 1e-7 * std::sqrt(Dot(before, before)));
}

// Against where the step began, stiffness would take a turn for a stretch, and stop it. Backward
// Euler alone takes little of the spin in small steps, and in large ones more than with damping.
TEST(RayleighDamping, StiffnessDampingLeavesASpinAlone) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {0.2, 0.1, 0.1}, {-0.1, -0.05, -0.05});
  const auto spin_left = [&](bool cut, double dt, std::optional<Damping> damping) {
    Scene scene = TightScene(1e9, 0.3, 1000, dt);
    scene.materials[0].tensile_strength = 1e12;
    scene.initial_velocities.emplace_back().angular_velocity = {0, 0, 20};
    if (cut) {
      // What flies apart turns about two centres.
      scene.weakenings.push_back({BoxSelector{{0.02, -1, -1}, {0.03, 1, 1}}, 0});
      AddBoxSet(scene, "right", {0.04, -1, -1}, {1, 1, 1});
      InitialVelocity& away = scene.initial_velocities.emplace_back();
      away.node_set = "right";
      away.velocity = {30, 0, 0};
    }
    scene.damping = damping;
    MovingBody run(scene, mesh);
    const double before = run.Spin();
    run.Steps(static_cast<int>(std::lround(0.1 / dt)));
    return run.Spin() / before;
  };
  for (const bool cut : {false, true}) {
    SCOPED_TRACE(cut ? "cut" : "whole");
    const double undamped = spin_left(cut, 0.001, std::nullopt);
    EXPECT_GT(undamped, 0.95);
    EXPECT_NEAR(spin_left(cut, 0.001, Damping{0, 1e-4}), undamped, 0.002);
    EXPECT_GE(spin_left(cut, 0.01, Damping{0, 1e-4}), spin_left(cut, 0.01, std::nullopt));
  }
}

// A body that is bent while it turns: what it deforms is damped.
TEST(RayleighDamping, StiffnessDampingTakesAVibrationFromABodyThatSpins) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1}, {-1, -0.5, -0.5});
  double elastic[2], spin[2];
  for (const int damped : {0, 1}) {
    Scene scene = TightScene(1e6, 0.3, 1000, 0.002);
    scene.initial_velocities.emplace_back().angular_velocity = {0, 0, 2};
    AddBoxSet(scene, "right", {0.4, -1, -1}, {3, 2, 2});
    InitialVelocity apart;
    apart.node_set = "right";
    apart.velocity = {0.5, 0, 0};
    scene.initial_velocities.push_back(apart);
    if (damped == 1) scene.damping = Damping{0, 0.02};
    MovingBody run(scene, mesh);
    const double before = run.Spin();
    ASSERT_NO_FATAL_FAILURE(run.Steps(30));
    elastic[damped] = run.elastic_energy();
    spin[damped] = run.Spin() / before;
    EXPECT_EQ(run.report.damping_dissipation > 0, damped == 1);
  }
  EXPECT_LT(elastic[1], 0.5 * elastic[0]);
  EXPECT_NEAR(spin[1], spin[0], 0.002);
}

// Two halves that fly apart: what is cut does not damp.
TEST(RayleighDamping, NoForceCrossesACut) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1});
  for (const bool cut : {false, true}) {
    Scene scene = TightScene(1e5, 0.3, 1000, 0.005);
    scene.materials[0].tensile_strength = 1e12;
    if (cut) scene.weakenings.push_back({BoxSelector{{1.2, -1, -1}, {1.3, 2, 2}}, 0});
    AddBoxSet(scene, "right", {1.4, -1, -1}, {3, 2, 2});
    InitialVelocity away;
    away.node_set = "right";
    away.velocity = {1e-3, 0, 0};
    scene.initial_velocities.push_back(away);
    scene.damping = Damping{0, 0.5};
    MovingBody run(scene, mesh);
    const double energy = KineticEnergy(run.model(), run.state);
    ASSERT_NO_FATAL_FAILURE(run.Steps(10));
    if (cut) {
      EXPECT_NEAR(KineticEnergy(run.model(), run.state), energy, 1e-9 * energy);
      EXPECT_NEAR(run.report.damping_dissipation, 0, 1e-9 * energy);
    } else {
      EXPECT_GT(run.report.damping_dissipation, 0.1 * energy);
    }
  }
}

TEST(RayleighDamping, AHalvedStepIsTwoStepsOfHalfTheLength) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1});
  const auto scene_of = [](double dt) {
    Scene scene = TightScene(1e5, 0.3, 1000, dt);
    scene.quality.newton_iterations = 3;
    scene.quality.residual_tolerance = 1e-4;
    scene.quality.step_tolerance = 1e-3;
    AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
    AddBoxSet(scene, "right", {2 - 1e-9, -1, -1}, {3, 2, 2});
    AddMotion(scene, "left");
    AddMotion(scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {0.125, {0.5, 0.25, 0}, 0}};
    scene.damping = Damping{1, 0.02};
    return scene;
  };
  MovingBody whole(scene_of(0.125), mesh);
  ASSERT_NO_FATAL_FAILURE(whole.Step());
  const int parts = whole.report.step_halvings + 1;
  MovingBody halves(scene_of(0.125 / parts), mesh);
  ASSERT_NO_FATAL_FAILURE(halves.Steps(parts));
  ASSERT_GT(parts, 1);
  ASSERT_EQ(halves.report.step_halvings, 0);
  for (size_t node = 0; node < whole.state.velocities.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(whole.state.velocities[node][axis], halves.state.velocities[node][axis]);
  }
  EXPECT_EQ(whole.report.damping_dissipation, halves.report.damping_dissipation);
}

TEST(RayleighDamping, HoldsWhatEachCoefficientNeeds) {
  const TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1});
  Scene scene = TightScene(1e5, 0.3, 1000, 0.01);
  scene.damping = Damping{0, 0};
  EXPECT_FALSE(BuildModel(scene, mesh)->damping.has_value());
  const int64_t bare = NewtonSolver(*BuildModel(scene, mesh)).bytes();
  for (const Damping damping : {Damping{1, 0}, Damping{0, 1}, Damping{1, 1}}) {
    scene.damping = damping;
    const Model model = *BuildModel(scene, mesh);
    const Footprint footprint =
        PlanModel(scene, mesh.node_count(), mesh.tet_count(), model.incidence->edge_count());
    int64_t planned = -1;
    for (const Part& part : footprint.parts)
      planned = part.name == "damping" ? part.bytes : planned;
    // As if every node came to be a piece.
    const std::vector<uint8_t> broken(model.incidence->edges.size(), 1);
    RayleighDamping alone(model);
    alone.SetBroken(broken);
    EXPECT_EQ(planned, alone.bytes());
    NewtonSolver solver(model);
    solver.SetBroken(broken);
    EXPECT_EQ(planned, solver.bytes() - bare);
  }
}

}  // namespace
}  // namespace cleave
