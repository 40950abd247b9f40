#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/mesh/tet_geometry.h"
#include "core/simulation/simulation.h"
#include "tests/unit/core/contact/test_surfaces.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/simulation/run_frames.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kGravity = 9.81;

// A block of rubber, 0.2 m x 0.2 m x 0.1 m.
TetMesh Block() { return KuhnBox({4, 4, 2}, {0.2, 0.2, 0.1}); }
Scene BlockScene(double dt) {
  Scene scene = TightScene(1e6, 0.3, 1000, dt);
  scene.quality.residual_tolerance = 1e-7;
  scene.quality.step_tolerance = 1e-7;
  scene.gravity = Vec3{0, 0, -kGravity};
  return scene;
}

Collider& AddCollider(Scene& scene, const Shape& shape, double friction = 0) {
  Collider& collider = scene.colliders.emplace_back();
  collider.shape = shape;
  collider.friction = friction;
  return collider;
}

double Lowest(const Simulation& simulation, size_t axis = 2) {
  double lowest = 1e300;
  for (const Vec3& position : simulation.positions()) lowest = std::min(lowest, position[axis]);
  return lowest;
}

Vec3 Mean(const Simulation& simulation) {
  Vec3 mean{0, 0, 0};
  for (const Vec3& position : simulation.positions()) {
    for (size_t i = 0; i < 3; ++i)
      mean[i] += position[i] / static_cast<double>(simulation.positions().size());
  }
  return mean;
}

Vec3 PointAt(const ColliderPlace& place, const Vec3& point) {
  const auto& [w, x, y, z] = place.rotation;
  const Eigen::Vector3d at =
      Eigen::Quaterniond(w, x, y, z) * Eigen::Vector3d(point[0], point[1], point[2]);
  return {at[0] + place.translation[0], at[1] + place.translation[1], at[2] + place.translation[2]};
}

TEST(Colliders, ABlockRestsOnThePlaneAsDeepAsItsWeightPresses) {
  Scene scene = BlockScene(0.01);
  AddCollider(scene, PlaneShape{}).stiffness = 2;
  auto simulation = *Simulation::Create(scene, Block(), {});
  const FrameReport report = RunFrames(*simulation, 300);
  // Pressure rho g H over an area of h^2 a node against c E h: within the factor that the mesh's
  // mean edge, longer than its cells, makes.
  const double h = 0.05;
  const double expected = h * 1000 * kGravity * 0.1 / (2 * 1e6);
  EXPECT_LT(Lowest(*simulation), -0.2 * expected);
  EXPECT_GT(Lowest(*simulation), -3 * expected);
  EXPECT_LT(report.kinetic_energy, 1e-9);
}

struct Slide {
  double distance = 0;      // m, in a second
  double acceleration = 0;  // m/s^2, in its second half
  FrameReport report;
};

// A block starts at rest on a plane that falls by `angle` along x.
Slide SlideDown(double angle, double friction) {
  Scene scene = BlockScene(0.01);
  scene.gravity = Vec3{kGravity * std::sin(angle), 0, -kGravity * std::cos(angle)};
  AddCollider(scene, PlaneShape{}, friction);
  auto simulation = *Simulation::Create(scene, Block(), {});
  double places[3] = {0, 0, 0};
  const double start = Mean(*simulation)[0];
  Slide slide;
  RunFrames(*simulation, 50);
  for (double& place : places) {
    place = Mean(*simulation)[0];
    slide.distance = place - start;
    slide.report = RunFrames(*simulation, 25);
  }
  slide.acceleration = (places[2] - 2 * places[1] + places[0]) / (0.25 * 0.25);
  return slide;
}

TEST(Colliders, ABlockOnAnInclineSlidesWhereItIsSteeperThanFriction) {
  const double angle = 0.3;  // tan = 0.309
  // While it settles it slips a little, then it stays.
  EXPECT_LT(std::abs(SlideDown(angle, 0.32).distance), 1e-2);
  EXPECT_NEAR(SlideDown(angle, 0.32).acceleration, 0, 1e-4);
  for (const double friction : {0.0, 0.1, 0.2, 0.29}) {
    const Slide slide = SlideDown(angle, friction);
    const double expected = kGravity * (std::sin(angle) - friction * std::cos(angle));
    EXPECT_NEAR(slide.acceleration, expected, 0.01 * expected + 1e-3) << friction;
    EXPECT_NEAR(Budget(slide.report, 0), 0, 1e-4 * slide.report.external_work);
  }
}

TEST(Colliders, FrictionTakesItsForceAlongTheWay) {
  Scene scene = BlockScene(0.01);
  AddCollider(scene, PlaneShape{}, 0.2);
  scene.initial_velocities.emplace_back().velocity = {2, 0, 0};
  auto simulation = *Simulation::Create(scene, Block(), {});
  const double start = Mean(*simulation)[0];
  const FrameReport report = RunFrames(*simulation, 200);
  // It stops, as the book says.
  const double distance = Mean(*simulation)[0] - start;
  EXPECT_NEAR(distance, 4 / (2 * 0.2 * kGravity), 0.06);
  EXPECT_LT(report.kinetic_energy, 1e-6);
  EXPECT_NEAR(report.friction_dissipation, 0.2 * 4 * kGravity * distance, 0.05 * 8);
  EXPECT_NEAR(Budget(report, 8), 0, 1e-4 * 8);
}

TEST(Colliders, ABlockThatSlidesTakesAFewIterationsAStep) {
  Scene scene = BlockScene(0.01);
  AddCollider(scene, PlaneShape{}, 0.2);
  scene.initial_velocities.emplace_back().velocity = {2, 0, 0};
  auto simulation = *Simulation::Create(scene, Block(), {});
  RunFrames(*simulation, 20);
  int32_t iterations = 0;
  for (int frame = 0; frame < 20; ++frame)
    iterations += RunFrames(*simulation, 1).newton_iterations;
  EXPECT_LE(iterations, 20 * 6);
}

TEST(Colliders, FrictionHoldsABlockWithoutCreep) {
  Scene scene = BlockScene(0.01);
  scene.gravity = Vec3{kGravity * std::sin(0.3), 0, -kGravity * std::cos(0.3)};
  AddCollider(scene, PlaneShape{}, 0.5);
  auto simulation = *Simulation::Create(scene, Block(), {});
  RunFrames(*simulation, 200);
  const double before = Mean(*simulation)[0];
  RunFrames(*simulation, 100);
  EXPECT_NEAR(Mean(*simulation)[0], before, 1e-8);
}

struct Drop {
  double rebound = 0;  // m/s, the highest afterwards
  double energy_gain = -1e300;
  double worst_budget = 0;
};

// A steel ball falls on a block that is held at its base.
Drop DropBall(double dt, double seconds, double velocity) {
  Scene scene = BlockScene(dt);
  scene.gravity.reset();
  AddBoxSet(scene, "base", {-1, -1, -1}, {1, 1, 1e-9});
  AddMotion(scene, "base");
  Collider& ball = AddCollider(scene, SphereShape{{0.1, 0.1, 0.16}, 0.05});
  ball.body.emplace().density = 7850;
  ball.body->velocity = {0, 0, -velocity};
  auto simulation = *Simulation::Create(scene, Block(), {});
  const double ball_mass = 7850 * 4.0 / 3 * std::acos(-1.0) * 0.05 * 0.05 * 0.05;
  const double energy = 0.5 * ball_mass * velocity * velocity;
  Drop drop;
  double last_z = 0;
  const StopFlag stop;
  for (int frame = 0; frame < seconds / dt; ++frame) {
    auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) break;
    const double z = report->colliders[0].translation[2];
    drop.rebound = std::max(drop.rebound, (z - last_z) / dt);
    last_z = z;
    const double total = report->kinetic_energy + report->elastic_energy + report->contact_energy;
    drop.energy_gain = std::max(drop.energy_gain, total / energy - 1);
    drop.worst_budget = std::max(drop.worst_budget, std::abs(Budget(*report, energy)) / energy);
    EXPECT_GE(report->integration_dissipation, -1e-9 * energy);
  }
  return drop;
}

TEST(Colliders, ABallOfSteelBouncesBackFromRubber) {
  const Drop fine = DropBall(1e-4, 0.06, 2);
  EXPECT_GT(fine.rebound, 0.3);
  EXPECT_LT(fine.rebound, 2);
  EXPECT_LT(fine.energy_gain, 1e-9);
  EXPECT_LT(fine.worst_budget, 1e-5);
}

TEST(Colliders, AStiffImpactGivesNoEnergyHoweverLongTheStep) {
  for (const double dt : {1e-3, 1e-2, 1e-1}) {
    const Drop drop = DropBall(dt, 0.5, 20);
    EXPECT_LT(drop.energy_gain, 1e-9) << dt;
    EXPECT_GE(drop.rebound, 0) << dt;
    EXPECT_LT(drop.rebound, 20) << dt;
    EXPECT_LT(drop.worst_budget, 1e-4) << dt;
  }
}

TEST(Colliders, ABallAndWhatItHitsKeepTheirMomentum) {
  Scene scene = BlockScene(1e-3);
  scene.gravity.reset();
  scene.quality.residual_tolerance = 1e-11;
  scene.quality.linear_tolerance = 1e-9;
  Collider& ball = AddCollider(scene, SphereShape{{0.13, 0.08, 0.155}, 0.05}, 0.5);
  ball.body.emplace().mass = 4;
  ball.body->velocity = {1, 0, -3};
  auto simulation = *Simulation::Create(scene, Block(), {});
  const FrameReport report = RunFrames(*simulation, 42);
  // Momentum is what the common centre of mass moves by.
  const TetMesh mesh = Block();
  std::vector<double> masses(mesh.rest_positions.size(), 0);
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const double volume = SignedVolume(CornersOf(mesh, tet));
    for (const int32_t node : mesh.tets[static_cast<size_t>(tet)])
      masses[static_cast<size_t>(node)] += 250 * volume;
  }
  const Vec3 center = PointAt(report.colliders[0], {0.13, 0.08, 0.155});
  Vec3 moved{4 * (center[0] - 0.13), 4 * (center[1] - 0.08), 4 * (center[2] - 0.155)};
  for (size_t n = 0; n < masses.size(); ++n) {
    for (size_t i = 0; i < 3; ++i)
      moved[i] += masses[n] * (simulation->positions()[n][i] - mesh.rest_positions[n][i]);
  }
  EXPECT_GT(center[2], 0.155 - 3 * 0.042 + 0.01);
  EXPECT_NEAR(moved[0], 4 * 1 * 0.042, 1e-10);
  EXPECT_NEAR(moved[1], 0, 1e-10);
  EXPECT_NEAR(moved[2], 4 * -3 * 0.042, 1e-10);
}

TEST(Colliders, AMovingPlateCrushesWhatItMeetsAndItsWorkIsCounted) {
  Scene scene = BlockScene(0.01);
  scene.gravity.reset();
  AddCollider(scene, PlaneShape{});
  Collider& plate = AddCollider(scene, BoxShape{{0.1, 0.1, 0.15}, {1, 1, 0.06}});
  plate.keyframes = {{0, {0, 0, 0}, 0}, {0.5, {0, 0, -0.05}, 0}};
  auto simulation = *Simulation::Create(scene, Block(), {});
  const FrameReport report = RunFrames(*simulation, 60);
  // 0.03 m of 0.1 m.
  EXPECT_GT(report.elastic_energy, 0.5 * 0.5 * 1e6 * 0.004 * 0.09);
  EXPECT_GT(report.external_work, report.elastic_energy);
  EXPECT_NEAR(Budget(report, 0), 0, 1e-4 * report.external_work);
  EXPECT_DOUBLE_EQ(report.colliders[1].translation[2], -0.05);
}

TEST(Colliders, AFastPlateDoesNotPassThrough) {
  Scene scene = BlockScene(0.04);
  scene.gravity.reset();
  Collider& plate = AddCollider(scene, BoxShape{{-0.1, 0.1, 0.05}, {0.04, 1, 1}});
  plate.keyframes = {{0, {0, 0, 0}, 0}, {1, {10, 0, 0}, 0}};
  auto simulation = *Simulation::Create(scene, Block(), {});
  EXPECT_GT(RunFrames(*simulation, 1).steps, 10);
  RunFrames(*simulation, 4);
  EXPECT_GT(Lowest(*simulation, 0), 2 - 0.1 + 0.02 - 0.01);
}

TEST(Colliders, EdgesAndCornersOfABoxHoldTheBlockToo) {
  for (const double tilt : {0.0, std::acos(-1.0) / 4}) {
    Scene scene = BlockScene(0.01);
    // Stands on an edge, or lies flat, under the middle of the block.
    const double depth = 0.1 * (tilt > 0 ? std::sqrt(2.0) : 1) + 0.02;
    Collider& box =
        AddCollider(scene, BoxShape{{0.1, 0.1, -depth}, {0.2, 1, 0.2}, {0, 1, 0}, tilt}, 0.5);
    // Rounded, so that nodes beside the edge are held too.
    box.margin = 0.02;
    auto simulation = *Simulation::Create(scene, Block(), {});
    RunFrames(*simulation, 50);
    EXPECT_GT(Mean(*simulation)[2], 0.03) << tilt;
  }
}

TEST(Colliders, ASurfaceActsAsTheSphereThatItIsMadeOf) {
  double heights[2];
  for (int k = 0; k < 2; ++k) {
    Scene scene = BlockScene(0.005);
    const Vec3 center{0.1, 0.1, -0.502};
    AddCollider(scene,
                k == 0 ? Shape(SphereShape{center, 0.5}) : Shape(SphereSurface(center, 0.5, 5)),
                0.5);
    auto simulation = *Simulation::Create(scene, Block(), {});
    RunFrames(*simulation, 60);
    heights[k] = Mean(*simulation)[2];
  }
  EXPECT_NEAR(heights[0], heights[1], 1e-3);
  EXPECT_GT(heights[0], 0.03);
}

TEST(Colliders, OneThatStartsInsideTheBodyPushesItOffAndStaysFinite) {
  Scene scene = BlockScene(0.01);
  AddCollider(scene, SphereShape{{0.1, 0.1, 0.05}, 0.08});
  AddCollider(scene, PlaneShape{{0, 0, 0.05}, {0, 0, 1}});
  auto simulation = *Simulation::Create(scene, Block(), {});
  const FrameReport report = RunFrames(*simulation, 50);
  for (const Vec3& position : simulation->positions()) {
    for (const double x : position) EXPECT_TRUE(std::isfinite(x) && std::abs(x) < 100);
  }
  EXPECT_TRUE(std::isfinite(report.elastic_energy));
}

Scene EverythingTouches() {
  Scene scene = BlockScene(0.005);
  AddCollider(scene, PlaneShape{{0, 0, -0.001}, {0, 0, 1}}, 0.4);
  Collider& ball = AddCollider(scene, SphereShape{{0.12, 0.07, 0.16}, 0.05}, 0.3);
  ball.body.emplace().density = 7850;
  ball.body->velocity = {0.5, 0, -3};
  ball.body->angular_velocity = {0, 20, 0};
  Collider& brick = AddCollider(scene, BoxShape{{0.26, 0.1, 0.05}, {0.1, 0.06, 0.04}}, 0.3);
  brick.body.emplace().mass = 0.5;
  brick.body->velocity = {-2, 0, 0};
  brick.body->angular_velocity = {3, 0, 9};
  return scene;
}

TEST(Colliders, GiveTheSameBitsOnAnyNumberOfThreads) {
  uint64_t hashes[2];
  for (int k = 0; k < 2; ++k) {
    auto simulation =
        *Simulation::Create(EverythingTouches(), KuhnBox({10, 10, 5}, {0.2, 0.2, 0.1}), {1 + k});
    RunFrames(*simulation, 5);
    hashes[k] = simulation->state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Colliders, GoOnFromASavedStateAsIfNothingHadHappened) {
  auto first = *Simulation::Create(EverythingTouches(), Block(), {});
  RunFrames(*first, 10);
  const std::string saved = first->Save();
  auto second = *Simulation::Create(EverythingTouches(), Block(), {});
  ASSERT_TRUE(second->Restore(saved).ok());
  EXPECT_EQ(first->state_hash(), second->state_hash());
  const FrameReport a = RunFrames(*first, 10), b = RunFrames(*second, 10);
  EXPECT_EQ(first->state_hash(), second->state_hash());
  EXPECT_EQ(a.colliders[2].rotation, b.colliders[2].rotation);
  EXPECT_EQ(a.contact_energy, b.contact_energy);
  EXPECT_EQ(a.friction_dissipation, b.friction_dissipation);
}

TEST(Colliders, ASpinningBrickKeepsItsAngularMomentum) {
  Scene scene = BlockScene(0.002);
  scene.gravity.reset();
  // Far from the block.
  Collider& brick = AddCollider(scene, BoxShape{{5, 5, 5}, {0.3, 0.2, 0.1}});
  brick.body.emplace().mass = 3;
  brick.body->angular_velocity = {1, 6, 0.5};
  auto simulation = *Simulation::Create(scene, Block(), {});
  const FrameReport start = RunFrames(*simulation, 1);
  const FrameReport end = RunFrames(*simulation, 1000);
  // Its energy wavers by what a step turns, and does not grow away.
  EXPECT_NEAR(end.kinetic_energy, start.kinetic_energy, 0.05 * start.kinetic_energy);
}

}  // namespace
}  // namespace cleave
