// The ledger of energy: what comes in from outside is what the body holds more and what was taken
// out of it by name, and nothing is created.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/simulation/ductile_bar.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kTolerance = 1e-4;  // of the largest energy in the ledger so far

struct Ledger {
  FrameReport last;
  double largest = 0;          // J, of any energy in the ledger so far
  double most_in_contact = 0;  // J
};

// Runs the scene and holds every frame's ledger to the tolerance.
Ledger MustClose(const Scene& scene, const TetMesh& mesh, double initial_kinetic_energy = 0) {
  Ledger ledger;
  const auto simulation = *Simulation::Create(scene, mesh, Simulation::Options{});
  const StopFlag stop;
  double dissipated = 0;
  for (int64_t frame = 0; frame < scene.timing.frame_count; ++frame) {
    const auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) break;
    const double held = report->kinetic_energy + report->elastic_energy + report->contact_energy;
    const double taken = report->fracture_energy + report->plastic_work +
                         report->friction_dissipation + report->damping_dissipation +
                         report->integration_dissipation;
    for (const double energy : {report->external_work, held, taken, initial_kinetic_energy})
      ledger.largest = std::max(ledger.largest, std::abs(energy));
    EXPECT_NEAR(report->external_work + initial_kinetic_energy, held + taken,
                kTolerance * ledger.largest)
        << "frame " << frame;
    EXPECT_GE(taken, dissipated - kTolerance * ledger.largest) << "frame " << frame;
    EXPECT_LE(held, report->external_work + initial_kinetic_energy + kTolerance * ledger.largest);
    dissipated = taken;
    // What is lost to one thing never comes back.
    EXPECT_GE(report->fracture_energy, ledger.last.fracture_energy) << "frame " << frame;
    EXPECT_GE(report->plastic_work, ledger.last.plastic_work) << "frame " << frame;
    EXPECT_GE(report->friction_dissipation, ledger.last.friction_dissipation) << "frame " << frame;
    EXPECT_GE(report->damping_dissipation, ledger.last.damping_dissipation) << "frame " << frame;
    ledger.most_in_contact = std::max(ledger.most_in_contact, report->contact_energy);
    ledger.last = *report;
  }
  return ledger;
}

// A bar along x, held at its left end.
Scene Bar(double dt, int frames) {
  Scene scene = TightScene(1e5, 0.3, 1000, dt);
  scene.quality.residual_tolerance = 1e-7;
  scene.timing.frame_count = frames;
  AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(scene, "right", {3 - 1e-9, -1, -1}, {4, 2, 2});
  AddMotion(scene, "left");
  return scene;
}

const TetMesh& BarMesh() {
  static const TetMesh mesh = KuhnBox({6, 2, 2}, {3, 1, 1});
  return mesh;
}

TEST(EnergyBudget, ClosesForABarThatFallsOnItsEndAndSwings) {
  Scene scene = Bar(0.02, 60);
  scene.gravity = Vec3{0, 0, -9.81};
  const Ledger ledger = MustClose(scene, BarMesh());
  EXPECT_GT(ledger.last.integration_dissipation, 0.01 * ledger.largest);
}

TEST(EnergyBudget, ClosesForEveryElasticLawAndFibres) {
  for (const ElasticLaw law : {ElasticLaw::kStableNeoHookean, ElasticLaw::kInvertibleNeoHookean,
                               ElasticLaw::kCorotatedLinear, ElasticLaw::kStVenantKirchhoff}) {
    Scene scene = Bar(0.01, 20);
    scene.materials[0].law = law;
    scene.materials[0].fibres.push_back({2e5, ConstantDirection{{1, 1, 0}}});
    AddMotion(scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {0.1, {0.4, 0, 0.2}, 0}};
    MustClose(scene, BarMesh());
  }
}

TEST(EnergyBudget, ClosesUnderLoadsThatComeAndGo) {
  for (const bool breaks : {false, true}) {
    Scene scene = Bar(0.01, 30);
    AddBoxSet(scene, "all", {-1, -1, -1}, {4, 2, 2});
    scene.loads = {{"right", SurfaceTraction{{1e4, 0, 0}}, {{0, 0}, {0.1, 1}}, {}},
                   {"right", PointForce{{0, 2e3, 0}}, {}, Release{.time = 0.155}}};
    scene.loads.push_back({"all", SurfacePressure{-5e3}, {{0.1, 0}, {0.2, 1}}, {}});
    if (breaks) scene.materials[0].tensile_strength = 1.1e4;
    scene.motions[0].release = Release{.time = 0.2};
    const Ledger ledger = MustClose(scene, BarMesh());
    EXPECT_EQ(ledger.last.broken_edges > 0, breaks);
    EXPECT_GT(ledger.last.external_work, 0.9 * ledger.largest);
  }
}

TEST(EnergyBudget, SmallerStepsLoseLessToIntegration) {
  double lost[2];
  for (const int k : {0, 1}) {
    const int steps = k == 0 ? 1 : 4;
    Scene scene = Bar(0.02 / steps, 40 * steps);
    scene.gravity = Vec3{0, 0, -9.81};
    const Ledger ledger = MustClose(scene, BarMesh());
    lost[k] = ledger.last.integration_dissipation / ledger.largest;
  }
  EXPECT_LT(lost[1], 0.5 * lost[0]);
}

TEST(EnergyBudget, ClosesForADampedBarThatSwingsAndIsPulledApart) {
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    for (const bool breaks : {false, true}) {
      Scene scene = Bar(0.01, 30);
      scene.quality.precision = precision;
      if (precision == Precision::kFloat) scene.quality.residual_tolerance = 1e-5;
      scene.gravity = Vec3{0, 0, -9.81};
      scene.damping = Damping{2, 0.005};
      if (breaks) scene.materials[0].tensile_strength = 1e4;
      AddMotion(scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {1, {3, 0, 0}, 0}};
      if (!breaks) scene.motions[1].release = Release{.time = 0.05};
      const Ledger ledger = MustClose(scene, BarMesh());
      EXPECT_EQ(ledger.last.fragments > 1, breaks);
      EXPECT_GT(ledger.last.damping_dissipation, 0.02 * ledger.largest);
    }
  }
}

TEST(EnergyBudget, ClosesForABodyThatSpins) {
  Scene scene = Bar(0.01, 30);
  scene.motions.clear();
  InitialVelocity spin;
  spin.angular_velocity = {0, 0, 4};
  spin.center = {1.5, 0.5, 0.5};
  spin.velocity = {1, 0, 0};
  scene.initial_velocities.push_back(spin);
  double kinetic = 0;
  {
    // A step so short that nothing has changed yet.
    Scene first = scene;
    first.timing.frames_per_second = 1e9;
    kinetic = (*Simulation::Create(first, BarMesh(), {}))->Advance(StopFlag{})->kinetic_energy;
  }
  MustClose(scene, BarMesh(), kinetic);
}

TEST(EnergyBudget, ClosesForABarThatIsPulledApart) {
  Scene scene = Bar(0.004, 60);
  scene.gravity = Vec3{0, 0, -9.81};
  scene.materials[0].tensile_strength = 1e4;
  AddMotion(scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {1, {3, 0, 0}, 0}};
  const Ledger ledger = MustClose(scene, BarMesh());
  EXPECT_GT(ledger.last.fragments, 1);
  EXPECT_GT(ledger.last.fracture_energy, 0.01 * ledger.largest);
}

TEST(EnergyBudget, ClosesForADuctileBarWithFibres) {
  for (const bool viscous : {false, true}) {
    Scene scene = TwistedBar();
    scene.timing.frame_count = 12;
    if (viscous) scene.materials[0].plasticity->flow_rate = 20;
    scene.materials[0].fibres.push_back({5e5, ConstantDirection{{1, 1, 0}}});
    const Ledger ledger = MustClose(scene, TwistedBarMesh());
    EXPECT_GT(ledger.last.plastic_work, 0.05 * ledger.largest);
  }
}

// A ductile bar with fibres and impurities over a rough floor: pressed from all sides for a while,
// pulled and twisted by a grip that lets go of what has come off, and driven back by a traction, so
// that the pieces rub against each other and the floor.
TEST(EnergyBudget, ClosesWithEveryPartAtOnce) {
  for (const double flow_rate : {std::numeric_limits<double>::infinity(), 50.0}) {
    Scene scene = Bar(0.005, 100);
    Material& metal = scene.materials[0];
    metal.youngs_modulus = 1e6;
    metal.plasticity = Plasticity{.yield_stress = 2e4, .hardening = 5e5, .flow_rate = flow_rate};
    metal.tensile_strength = 8e4;
    metal.fibres.push_back({2e5, ConstantDirection{{1, 1, 0}}});
    scene.impurities = Impurities{.noise = 0.1};
    scene.gravity = Vec3{0, 0, -9.81};
    if (std::isinf(flow_rate)) scene.damping = Damping{0.5, 0.001};
    scene.contact = Contact{.stiffness = 5, .friction = 0.3};
    scene.colliders.emplace_back().shape = PlaneShape{{0, 0, -0.25}, {0, 0, 1}};
    scene.colliders[0].friction = 0.4;
    Motion& grip = AddMotion(scene, "right");
    grip.rotation_center = {3, 0.5, 0.5};
    grip.rotation_axis = {1, 0, 0};
    grip.keyframes = {{0, {0, 0, 0}, 0}, {0.3, {0.9, 0, 0}, 0.5}};
    grip.release = Release{.pieces = 2};
    AddBoxSet(scene, "all", {-1, -1, -1}, {4, 2, 2});
    scene.loads.push_back(
        {"all", SurfacePressure{3e3}, {{0, 0}, {0.05, 1}}, Release{.time = 0.15}});
    scene.loads.push_back(
        {"right", SurfaceTraction{{-4e3, 0, -1e3}}, {{0.2, 0}, {0.25, 1}}, Release{.time = 0.5}});
    const Ledger ledger = MustClose(scene, BarMesh());
    EXPECT_GT(ledger.last.fragments, 1);
    EXPECT_GT(ledger.last.plastic_work, 0.01 * ledger.largest);
    EXPECT_GT(ledger.last.fracture_energy, 0.005 * ledger.largest);
    EXPECT_GT(ledger.last.friction_dissipation, 0.005 * ledger.largest);
    EXPECT_EQ(ledger.last.damping_dissipation > 0.005 * ledger.largest, scene.damping.has_value());
    EXPECT_GT(ledger.most_in_contact, 0.001 * ledger.largest);
  }
}

}  // namespace
}  // namespace cleave
