#include "core/solver/stepper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/model/build_model.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

const double kPi = std::acos(-1.0);

// A bar that can only move along itself, held at both ends, in its lowest mode: amplitude, as a
// share of the start, after one period in `steps` steps. Waves in it are as fast as the modulus of
// confined strain makes them.
double AmplitudeAfterAPeriod(double poisson_ratio, int steps, double* phase_error) {
  const int cells = 40;
  const double youngs_modulus = 1e6, density = 1000;
  const double confined =
      youngs_modulus * (1 - poisson_ratio) / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio));
  const double period = 2 / std::sqrt(confined / density);
  const double dt = period / steps;
  const TetMesh mesh = KuhnBox({cells, 1, 1}, {1, 1.0 / cells, 1.0 / cells});
  Scene scene = TightScene(youngs_modulus, poisson_ratio, density, dt);
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
  for (const double poisson_ratio : {0.0, 0.3}) {
    double phase_error = 0;
    EXPECT_NEAR(AmplitudeAfterAPeriod(poisson_ratio, 100, &phase_error), 0.821, 0.001);
    EXPECT_NEAR(phase_error, 0, 0.002);
    EXPECT_NEAR(AmplitudeAfterAPeriod(poisson_ratio, 400, &phase_error), 0.952, 0.001);
    EXPECT_NEAR(phase_error, 0, 0.0005);
  }
}

// At default quality: a rule of stopping by a force or an energy of fixed size would let a stiff
// body float where it is.
TEST(Stepper, AColumnSagsByItsWeightHoweverStiffItIs) {
  const double height = 4;
  const TetMesh mesh = KuhnBox({1, 1, 8}, {1, 1, height});
  for (const double youngs_modulus : {1e7, 1e9, 1e11, 1e13}) {
    SCOPED_TRACE(youngs_modulus);
    Scene scene = TightScene(youngs_modulus, 0, 1000, 0.1);
    scene.quality = Quality{};
    scene.gravity = Vec3{0, 0, -9.81};
    AddBoxSet(scene, "foot", {-1, -1, -1}, {2, 2, 1e-9});
    AddMotion(scene, "foot");
    const Model model = *BuildModel(scene, mesh);
    Stepper stepper(model);
    State state = InitialState(scene, mesh, model);
    const StopFlag stop;
    for (int step = 0; step < 20; ++step) {
      StepReport report;
      ASSERT_TRUE(stepper.Step(0.1 * step, 0.1 * (step + 1), stop, state, report).ok());
      EXPECT_LE(report.residual, scene.quality.residual_tolerance);
    }
    const double sag = 1000 * 9.81 * height * height / (2 * youngs_modulus);
    double mean = 0;  // of the four nodes on top
    for (size_t node = 0; node < state.displacements.size(); ++node) {
      if (model.mesh->rest_positions[node][2] > height - 1e-9)
        mean -= state.displacements[node][2] / 4;
    }
    EXPECT_NEAR(mean / sag, 1, 0.001);
  }
}

// Records the energy of the whole step, E(x), at every iterate that a solve builds a matrix at.
class EnergyRecorder final : public NodeTerm {
 public:
  EnergyRecorder(const Model& model, std::vector<double>& energies)
      : model_(model), energies_(energies) {}
  absl::string_view name() const override { return "a test's recorder"; }
  int64_t bytes() const override { return 0; }
  void BeginStep(double start, double end, const State& state) override {
    start_ = state;
    dt_ = end - start;
    energies_.push_back(std::numeric_limits<double>::infinity());
  }
  double AddForces(const NodalVector&, NodalVector&) override { return 0; }
  void AddStiffness(const NodalVector& displacements, Curvature, NodeCouplings&) override {
    const Double4 gravity = model_.gravity ? ToDouble4(*model_.gravity) : Splat(0);
    NodalVector forces(displacements.size(), Splat(0));
    double energy = 0;
    for (const auto& term : model_.tet_terms) energy += term->AddForces(displacements, forces);
    for (const auto& term : model_.node_terms) energy += term->AddForces(displacements, forces);
    for (size_t node = 0; node < displacements.size(); ++node) {
      const Double4 moved = displacements[node] - start_.displacements[node];
      const Double4 ahead = moved - dt_ * start_.velocities[node];
      energy += model_.masses[node] * (0.5 / (dt_ * dt_) * Dot(ahead, ahead) - Dot(gravity, moved));
    }
    energies_.push_back(energy);
  }
  NodeTermWork EndStep(const State&) override { return {}; }

 private:
  const Model& model_;
  std::vector<double>& energies_;  // J, infinity before each step
  State start_;
  double dt_ = 0;
};

// Runs a scene and holds that no iterate of any solve has more energy than the one before, also
// after breaks; returns how often it fell.
int FallsOfEnergy(const Scene& scene, const TetMesh& mesh, int steps) {
  const double dt = 1 / scene.timing.frames_per_second;
  Model model = *BuildModel(scene, mesh);
  std::vector<double> energies;
  model.node_terms.push_back(std::make_unique<EnergyRecorder>(model, energies));
  Stepper stepper(model);
  State state = InitialState(scene, mesh, model);
  const StopFlag stop;
  for (int step = 0; step < steps; ++step) {
    StepReport report;
    const absl::Status status = stepper.Step(dt * step, dt * (step + 1), stop, state, report);
    EXPECT_TRUE(status.ok()) << status;
    if (!status.ok()) break;
  }
  const double rounding = scene.quality.precision == Precision::kFloat ? 1e-6 : 1e-12;
  int falls = 0;
  for (size_t k = 1; k < energies.size(); ++k) {
    if (std::isinf(energies[k]) || std::isinf(energies[k - 1])) continue;
    EXPECT_LE(energies[k], energies[k - 1] + rounding * std::abs(energies[k - 1]));
    falls += energies[k] < energies[k - 1] ? 1 : 0;
  }
  return falls;
}

// A cube whose lid goes through its floor, over a ball that it rubs against: tets that turn inside
// out, fibres that turn over, contact that comes and goes.
TEST(Stepper, EnergyFallsFromIterateToIterate) {
  int falls = 0;
  for (const ElasticLaw law : {ElasticLaw::kStableNeoHookean, ElasticLaw::kInvertibleNeoHookean,
                               ElasticLaw::kCorotatedLinear, ElasticLaw::kStVenantKirchhoff}) {
    for (const bool with_fibres : {false, true}) {
      const double dt = 0.02;
      Scene scene = TightScene(1e6, 0.3, 1000, dt);
      scene.quality = Quality{};
      scene.quality.newton_iterations = 100;
      scene.materials[0].law = law;
      if (with_fibres) scene.materials[0].fibres = {{2e6, ConstantDirection{{1, 0, 2}}}};
      scene.gravity = Vec3{0, 0, -9.81};
      scene.colliders.emplace_back().shape = SphereShape{{0.5, 1.4, 0.5}, 0.38};
      scene.colliders[0].friction = 0.5;
      AddBoxSet(scene, "floor", {-1, -1, -1}, {2, 2, 1e-9});
      AddBoxSet(scene, "lid", {-1, -1, 1 - 1e-9}, {2, 2, 2});
      AddMotion(scene, "floor");
      AddMotion(scene, "lid").keyframes = {{0, {0, 0, 0}, 0}, {10 * dt, {0, 0.3, -1.5}, 0}};
      for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
        scene.quality.precision = precision;
        falls += FallsOfEnergy(scene, KuhnBox({3, 3, 3}, {1, 1, 1}), 15);
      }
    }
  }
  EXPECT_GT(falls, 1000);
}

// A bar that is torn in two, brittle and ductile: what breaks holds less energy than it did.
TEST(Stepper, EnergyFallsFromIterateToIterateThroughBreaks) {
  for (const bool ductile : {false, true}) {
    for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
      Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
      scene.quality.residual_tolerance = 1e-6;
      scene.quality.precision = precision;
      scene.materials[0].tensile_strength = 1e5;
      if (ductile)
        scene.materials[0].plasticity = Plasticity{.yield_stress = 6e4, .hardening = 1e5};
      AddBoxSet(scene, "held", {-1, -1, -1}, {1e-9, 2, 2});
      AddBoxSet(scene, "pulled", {2 - 1e-9, -1, -1}, {3, 2, 2});
      AddMotion(scene, "held");
      AddMotion(scene, "pulled").keyframes = {{0, {0, 0, 0}, 0}, {0.4, {1.6, 0, 0}, 0}};
      EXPECT_GT(FallsOfEnergy(scene, KuhnBox({6, 3, 3}, {2, 1, 1}), 40), 50)
          << ductile << " " << static_cast<int>(precision);
    }
  }
}

// Mean deflection per load of the end of a cantilever of 8 x 1 x 1 m, n cells across, under a load
// that is spread over its end.
double DeflectionOverLoad(int n) {
  const TetMesh mesh = KuhnBox({8 * n, n, n}, {8, 1, 1});
  Scene scene = TightScene(1e6, 0, 1e-9, 10);
  scene.quality.residual_tolerance = 1e-8;
  scene.quality.step_tolerance = 1e-6;
  AddBoxSet(scene, "wall", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(scene, "end", {8 - 1e-9, -1, -1}, {9, 2, 2});
  AddMotion(scene, "wall");
  const double load = 1e-3;  // N, small: the reference is linear
  scene.loads.push_back({"end", SurfaceTraction{{0, 0, -load}}, {}, std::nullopt});
  const Model model = *BuildModel(scene, mesh);
  Stepper stepper(model);
  State state = InitialState(scene, mesh, model);
  const StopFlag stop;
  for (int step = 0; step < 4; ++step) {
    StepReport report;
    EXPECT_TRUE(stepper.Step(10 * step, 10 * (step + 1), stop, state, report).ok());
  }
  double sum = 0;
  int count = 0;
  for (size_t node = 0; node < state.displacements.size(); ++node) {
    if (model.mesh->rest_positions[node][0] < 8 - 1e-9) continue;
    sum += state.displacements[node][2];
    ++count;
  }
  return sum / count / load;
}

TEST(Cantilever, BendsAsTheReferenceTableAndConvergesToTimoshenko) {
  constexpr double kTimoshenko = -0.0020672;  // m/N
  const struct {
    int cells;
    double deflection, ratio, rate;  // the error's order of convergence since the row before
  } rows[] = {{1, -0.0005073552108764555, 0.2454, 0},
              {2, -0.0011377043233467181, 0.5504, 0.75},
              {4, -0.001704417280292223, 0.8245, 1.36},
              {6, -0.0018865305996319103, 0.9126, 1.72}};
  double last_error = 0;
  int last_cells = 0;
  for (const auto& row : rows) {
    const double deflection = DeflectionOverLoad(row.cells);
    EXPECT_NEAR(deflection / row.deflection, 1, 1e-5) << row.cells << " cells";
    EXPECT_NEAR(deflection / kTimoshenko, row.ratio, 5e-5) << row.cells << " cells";
    const double error = 1 - deflection / kTimoshenko;
    if (last_cells > 0) {
      const double refined = static_cast<double>(row.cells) / last_cells;
      EXPECT_NEAR(std::log(last_error / error) / std::log(refined), row.rate, 0.005);
    }
    last_error = error;
    last_cells = row.cells;
  }
}

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
  EXPECT_LE(report.shortest_step, 0.05);
  for (const FixedNode& fixed : stepper.solver().fixed_nodes()) {
    const auto node = static_cast<size_t>(fixed.node);
    const double wanted = model.mesh->rest_positions[node][0] > 1 ? 1 : 0;
    EXPECT_DOUBLE_EQ(state.displacements[node][0], wanted);
  }
}

// Gravity pushes the tip of a tet through its base. While its fibre counts as upright the tip comes
// to rest below the base, and while it counts as turned over, above.
TEST(Stepper, AFibreThatTurnsOverAndBackDoesNotKeepASolveFromItsEnd) {
  struct Case {
    Vec3 fibre, gravity;  // m/s^2
  };
  constexpr Case kCases[] = {{{0.7, -0.1, 0.2}, {4000, 0, -6000}},
                             {{-0.9, -0.7, 0.4}, {-1000, 0, -8000}}};
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  const double dt = 0.02;
  for (const Case& crushed : kCases) {
    Scene scene = TightScene(1e5, 0.4, 1000, dt);
    scene.quality.newton_iterations = 30;
    scene.quality.residual_tolerance = 1e-6;
    scene.quality.step_tolerance = 1e-5;
    FibreFamily family;
    family.stiffness = 1e7;
    family.direction = ConstantDirection{crushed.fibre};
    scene.materials[0].fibres.push_back(family);
    AddBoxSet(scene, "base", {-1, -1, -1}, {2, 2, 1e-9});
    AddMotion(scene, "base");
    scene.gravity = crushed.gravity;
    const Model model = *BuildModel(scene, mesh);
    State state = InitialState(scene, mesh, model);
    Stepper stepper(model);
    const StopFlag stop;
    StepReport report;
    for (int step = 0; step < 20; ++step) {
      const absl::Status status = stepper.Step(dt * step, dt * (step + 1), stop, state, report);
      ASSERT_TRUE(status.ok()) << "step " << step << ": " << status;
    }
  }
}

}  // namespace
}  // namespace cleave
