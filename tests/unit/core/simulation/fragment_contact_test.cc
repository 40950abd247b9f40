#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/mesh/tet_geometry.h"
#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/simulation/run_frames.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

// Two blocks a little apart, the right one half a cell higher: nodes meet faces.
TetMesh TwoBlocks() {
  TetMesh mesh = KuhnBox({3, 3, 3}, {0.3, 0.3, 0.3});
  AppendMesh(mesh, KuhnBox({3, 3, 3}, {0.3, 0.3, 0.3}, {0.43, 0.03, 0.05}));
  return mesh;
}

Scene Collision(double dt, double friction) {
  Scene scene = TightScene(1e6, 0.3, 1000, dt);
  scene.contact = Contact{5, friction};
  AddBoxSet(scene, "left", {-1, -1, -1}, {0.35, 1, 1});
  AddBoxSet(scene, "right", {0.4, -1, -1}, {2, 1, 1});
  scene.initial_velocities.resize(2);
  scene.initial_velocities[0].node_set = "left";
  scene.initial_velocities[0].velocity = {3, 0, 0.5};
  scene.initial_velocities[1].node_set = "right";
  scene.initial_velocities[1].velocity = {-1, 0, 0};
  return scene;
}

std::vector<double> Masses(const TetMesh& mesh, double density) {
  std::vector<double> masses(mesh.rest_positions.size(), 0);
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    for (const int32_t node : mesh.tets[static_cast<size_t>(tet)]) {
      masses[static_cast<size_t>(node)] += density / 4 * SignedVolume(CornersOf(mesh, tet));
    }
  }
  return masses;
}

// How far the common centre of mass is from where momentum would have it, over how far the fastest
// block went.
double Drift(const Simulation& simulation, const TetMesh& mesh, const std::vector<double>& masses) {
  Vec3 way{0, 0, 0};
  for (size_t n = 0; n < masses.size(); ++n) {
    for (size_t i = 0; i < 3; ++i)
      way[i] += masses[n] * (simulation.positions()[n][i] - mesh.rest_positions[n][i]);
  }
  const double time = simulation.time(), mass = 27;
  return std::hypot(way[0] - mass * (3 - 1) * time, way[1], way[2] - mass * 0.5 * time) /
         (mass * 3 * time);
}

TEST(FragmentContact, MomentumIsKeptHoweverLooselyStepsAreSolved) {
  const TetMesh mesh = TwoBlocks();
  const std::vector<double> masses = Masses(mesh, 1000);
  for (const double friction : {0.0, 0.4}) {
    Scene scene = Collision(2e-2, friction);
    scene.quality = Quality{};
    auto simulation = *Simulation::Create(scene, mesh, {});
    double contact = 0;
    for (int frame = 0; frame < 10; ++frame)
      contact = std::max(contact, MustAdvance(*simulation).contact_energy);
    EXPECT_GT(contact, 1e-3);
    EXPECT_LT(Drift(*simulation, mesh, masses), 1e-8);
  }
}

TEST(FragmentContact, TwoBlocksThatCollideKeepMomentumAndMakeNoEnergy) {
  const TetMesh mesh = TwoBlocks();
  const std::vector<double> masses = Masses(mesh, 1000);
  for (const double dt : {1e-3, 2e-2}) {
    for (const double friction : {0.0, 0.4}) {
      auto simulation = *Simulation::Create(Collision(dt, friction), mesh, {});
      const double energy = 0.5 * 27 * (9 + 0.25 + 1);
      const StopFlag stop;
      double contact = 0;
      FrameReport report;
      for (int frame = 0; frame < 0.2 / dt; ++frame) {
        report = *simulation->Advance(stop);
        contact = std::max(contact, report.contact_energy);
        EXPECT_LT(report.kinetic_energy + report.elastic_energy + report.contact_energy,
                  energy * (1 + 1e-9));
      }
      EXPECT_GT(contact, 1e-3);
      // Pairs push and pull as much as they are pushed and pulled, in forces and in the matrix, so
      // what is left is rounding.
      EXPECT_LT(Drift(*simulation, mesh, masses), 1e-14);
      EXPECT_NEAR(Budget(report, energy), 0, 1e-5 * energy);
      EXPECT_GE(report.friction_dissipation, 0);
      EXPECT_EQ(report.friction_dissipation > 0, friction > 0);
      // The left one stays left.
      double left = -1e300, right = 1e300;
      for (size_t n = 0; n < masses.size(); ++n) {
        const double x = simulation->positions()[n][0];
        if (n < masses.size() / 2) left = std::max(left, x);
        if (n >= masses.size() / 2) right = std::min(right, x);
      }
      EXPECT_LT(left, right + 0.1);
    }
  }
}

// A bar that is cut in the middle, whose halves are pushed together.
Scene PushedTogether(bool contact) {
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  scene.quality.residual_tolerance = 1e-7;
  scene.weakenings = {{BoxSelector{{0.45, -1, -1}, {0.55, 1, 1}}, 0}};
  if (contact) scene.contact.emplace();
  AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 1, 1});
  AddBoxSet(scene, "right", {1 - 1e-9, -1, -1}, {2, 1, 1});
  AddMotion(scene, "left");
  AddMotion(scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {0.5, {-0.15, 0, 0}, 0}};
  return scene;
}

TEST(FragmentContact, CrackFacesDoNotCloseThroughEachOther) {
  for (const bool contact : {false, true}) {
    const TetMesh mesh = KuhnBox({10, 2, 2}, {1, 0.2, 0.2});
    auto simulation = *Simulation::Create(PushedTogether(contact), mesh, {});
    const FrameReport report = RunFrames(*simulation, 60);
    EXPECT_GT(report.fragments, 1);
    // Where the right half began, and where the left half ends.
    double left = -1e300, right = 1e300;
    for (size_t n = 0; n < mesh.rest_positions.size(); ++n) {
      const double x = simulation->positions()[n][0];
      if (mesh.rest_positions[n][0] < 0.45) left = std::max(left, x);
      if (mesh.rest_positions[n][0] > 0.55) right = std::min(right, x);
    }
    // Without contact the halves move through each other by what the grip does.
    if (contact) {
      EXPECT_GT(right - left, 0.05);
      EXPECT_LT(report.motion_forces[1][0], -100);
    } else {
      EXPECT_NEAR(right - left, 0.05, 0.03);
      EXPECT_NEAR(report.motion_forces[1][0], 0, 20);
    }
    EXPECT_NEAR(Budget(report, 0), 0, 1e-4 * (1 + report.external_work));
  }
}

Scene Shatter() {
  Scene scene = Collision(0.002, 0.3);
  scene.quality.residual_tolerance = 1e-6;
  scene.materials[0].tensile_strength = 5e3;
  scene.gravity = Vec3{0, 0, -9.81};
  scene.colliders.emplace_back().shape = PlaneShape{{0, 0, -0.01}, {0, 0, 1}};
  scene.colliders[0].friction = 0.3;
  return scene;
}

TEST(FragmentContact, BreakingBodiesCloseTheirBudgetToo) {
  auto simulation = *Simulation::Create(Shatter(), TwoBlocks(), {});
  const double energy = 0.5 * 27 * (9 + 0.25 + 1);
  const FrameReport report = RunFrames(*simulation, 60);
  EXPECT_GT(report.fragments, 2);
  EXPECT_NEAR(Budget(report, energy), 0, 1e-5 * energy);
  EXPECT_LT(report.kinetic_energy + report.elastic_energy + report.contact_energy,
            energy + report.external_work);
}

TEST(FragmentContact, GivesTheSameBitsOnAnyNumberOfThreads) {
  uint64_t hashes[2];
  for (int k = 0; k < 2; ++k) {
    auto simulation = *Simulation::Create(Shatter(), TwoBlocks(), {1 + k});
    RunFrames(*simulation, 30);
    hashes[k] = simulation->state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(FragmentContact, GoesOnFromASavedStateAsIfNothingHadHappened) {
  auto first = *Simulation::Create(Shatter(), TwoBlocks(), {});
  RunFrames(*first, 30);
  auto second = *Simulation::Create(Shatter(), TwoBlocks(), {});
  ASSERT_TRUE(second->Restore(first->Save()).ok());
  const FrameReport a = RunFrames(*first, 15), b = RunFrames(*second, 15);
  EXPECT_GT(a.contact_energy, 0);
  EXPECT_EQ(first->state_hash(), second->state_hash());
  EXPECT_EQ(a.contact_energy, b.contact_energy);
}

}  // namespace
}  // namespace cleave
