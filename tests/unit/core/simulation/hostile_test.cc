// Inputs of the method note, section 12, that must simulate: finite, and what else each may claim.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

// A soft unit cube under gravity on its pinned floor, at default quality.
Scene Cube() {
  Scene scene = TightScene(1e5, 0.3, 1000, 0.01);
  scene.quality = Quality{};
  scene.gravity = Vec3{0, 0, -9.81};
  AddBoxSet(scene, "floor", {-1e9, -1e9, -1e9}, {1e9, 1e9, 1e-12});
  AddMotion(scene, "floor");
  return scene;
}

class Hostile : public ::testing::TestWithParam<Precision> {
 protected:
  std::unique_ptr<Simulation> MustRun(Scene scene, const TetMesh& mesh, int frames) const;
  std::unique_ptr<Simulation> Crush(double depth) const;
};

INSTANTIATE_TEST_SUITE_P(InBothPrecisions, Hostile,
                         ::testing::Values(Precision::kDouble, Precision::kFloat),
                         [](const auto& test) {
                           return test.param == Precision::kFloat ? "Float" : "Double";
                         });

std::unique_ptr<Simulation> Hostile::MustRun(Scene scene, const TetMesh& mesh, int frames) const {
  scene.quality.precision = GetParam();
  auto simulation = *Simulation::Create(scene, mesh, Simulation::Options{});
  const StopFlag stop;
  for (int frame = 0; frame < frames; ++frame) {
    const auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << "frame " << frame << ": " << report.status();
    if (!report.ok()) break;
    EXPECT_TRUE(std::isfinite(report->kinetic_energy + report->elastic_energy +
                              report->external_work + report->residual));
  }
  for (const Vec3& position : simulation->positions()) {
    for (const double coordinate : position) EXPECT_TRUE(std::isfinite(coordinate));
  }
  return simulation;
}

TEST_P(Hostile, StiffnessFromFoamToBeyondDiamond) {
  for (const double youngs_modulus : {1e-3, 1.0, 1e5, 1e9, 1e13}) {
    SCOPED_TRACE(youngs_modulus);
    Scene scene = Cube();
    scene.materials[0].youngs_modulus = youngs_modulus;
    scene.quality.newton_iterations = 60;
    MustRun(scene, KuhnBox({3, 3, 3}, {1, 1, 1}), 5);
  }
}

TEST_P(Hostile, StepsOfTenthsOfMicroseconds) {
  Scene scene = Cube();
  scene.timing.frames_per_second = 1e7;
  MustRun(scene, KuhnBox({3, 3, 3}, {1, 1, 1}), 5);
}

TEST_P(Hostile, StepsOfNanosecondsOfASpinningBodyEndAtRounding) {
  Scene scene = TightScene(1e5, 0.3, 1000, 1e-9);
  InitialVelocity spin;
  spin.angular_velocity = {0, 0, 4};
  scene.initial_velocities.push_back(spin);
  MustRun(scene, KuhnBox({3, 3, 3}, {1, 1, 1}), 3);
}

TEST_P(Hostile, BodiesFromNanometresToThousandsOfKilometres) {
  for (const double size : {1e-9, 1e-3, 1e3, 1e6}) {
    SCOPED_TRACE(size);
    Scene scene = Cube();
    scene.materials[0].youngs_modulus = 1e5 * std::max(1.0, size);
    // As the cube of a metre looks, in its own time.
    scene.node_sets[0].select = {BoxSelector{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e-6 * size}}};
    const auto simulation = MustRun(scene, KuhnBox({3, 3, 3}, {size, size, size}), 5);
    EXPECT_LT(simulation->positions().back()[2], size);
  }
}

TEST_P(Hostile, FarFromTheOriginTheBodyFallsTheSame) {
  Scene scene = TightScene(1e5, 0.3, 1000, 0.01);
  scene.gravity = Vec3{0, 0, -9.81};
  const auto near = MustRun(scene, KuhnBox({2, 2, 2}, {1, 1, 1}), 10);
  const double far = 0x1.0p26;  // m; a power of two leaves the cell's corners exact
  const auto away = MustRun(scene, KuhnBox({2, 2, 2}, {1, 1, 1}, {far, far, far}), 10);
  for (size_t node = 0; node < near->positions().size(); ++node)
    EXPECT_NEAR(away->positions()[node][2] - far, near->positions()[node][2], 1e-7);
}

TEST_P(Hostile, OneTet) {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  const auto simulation = MustRun(Cube(), mesh, 20);
  EXPECT_LT(simulation->positions()[3][2], 1);
  EXPECT_EQ(simulation->positions()[1], (Vec3{1, 0, 0}));
}

TEST_P(Hostile, PiecesThatDoNotTouchAndNodesOfNoTet) {
  TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1});
  mesh.rest_positions.push_back({7, 7, 7});
  const TetMesh other = KuhnBox({1, 1, 1}, {1, 1, 1}, {5, 0, 3});
  const auto offset = static_cast<int32_t>(mesh.node_count());
  for (const Vec3& position : other.rest_positions) mesh.rest_positions.push_back(position);
  for (auto tet : other.tets) {
    for (int32_t& node : tet) node += offset;
    mesh.tets.push_back(tet);
  }
  const auto simulation = MustRun(Cube(), mesh, 10);
  EXPECT_EQ(simulation->fragments(), 2);
  // The lone node rests, the upper block falls.
  EXPECT_EQ(simulation->positions()[static_cast<size_t>(offset) - 1], (Vec3{7, 7, 7}));
  EXPECT_NEAR(simulation->positions().back()[2], 4 - 9.81 * 1e-4 * 55, 1e-6);
}

TEST_P(Hostile, BlocksJoinedByANode) {
  TetMesh mesh = KuhnBox({1, 1, 1}, {1, 1, 1});
  const TetMesh other = KuhnBox({1, 1, 1}, {1, 1, 1}, {1, 1, 1});
  for (auto tet : other.tets) {
    for (int32_t& node : tet) node = node == 0 ? 7 : node + 7;
    mesh.tets.push_back(tet);
  }
  for (size_t node = 1; node < other.rest_positions.size(); ++node)
    mesh.rest_positions.push_back(other.rest_positions[node]);
  MustRun(Cube(), mesh, 20);
}

TEST_P(Hostile, AllNodesPinnedAndStillTheStressBreaks) {
  const TetMesh mesh = KuhnBox({2, 1, 1}, {2, 1, 1});
  Scene scene = TightScene(1e5, 0.3, 1000, 0.01);
  AddBoxSet(scene, "left", {-1, -1, -1}, {0.5, 2, 2});
  AddBoxSet(scene, "rest", {0.5, -1, -1}, {3, 2, 2});
  AddMotion(scene, "left");
  AddMotion(scene, "rest").keyframes = {{0, {0, 0, 0}, 0}, {0.1, {1, 0, 0}, 0}};
  scene.materials[0].tensile_strength = 3e4;
  const auto simulation = MustRun(scene, mesh, 10);
  EXPECT_FALSE(simulation->broken_edges().empty());
  // The first cell is torn out: its four outer nodes, and the rest.
  EXPECT_EQ(simulation->fragments(), 5);
}

TEST_P(Hostile, NothingMovesToTheLastBit) {
  const TetMesh mesh = KuhnBox({3, 3, 3}, {0.7, 0.3, 1.1}, {0.1, 0.2, 0.3});
  Scene scene = TightScene(1e5, 0.3, 1000, 0.01);
  scene.materials[0].tensile_strength = 1;
  AddBoxSet(scene, "floor", {-9, -9, -9}, {9, 9, 0.4});
  AddMotion(scene, "floor");
  const auto simulation = MustRun(scene, mesh, 10);
  EXPECT_EQ(simulation->positions(), mesh.rest_positions);
}

TEST_P(Hostile, NoStrengthCutsEverythingAtOnceAndInfiniteStrengthNothing) {
  Scene scene = Cube();
  scene.materials[0].tensile_strength = 0;
  const TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1});
  const auto cut = MustRun(scene, mesh, 10);
  EXPECT_EQ(cut->fragments(), mesh.node_count());
  EXPECT_NEAR(cut->positions().back()[2], 1 - 9.81 * 1e-4 * 55, 1e-3);
  scene.materials[0].tensile_strength = std::numeric_limits<double>::infinity();
  const auto whole = MustRun(scene, mesh, 10);
  EXPECT_TRUE(whole->broken_edges().empty());
}

// A lid goes down by `depth` of the cube's height and comes back.
std::unique_ptr<Simulation> Hostile::Crush(double depth) const {
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  scene.quality = Quality{};
  scene.quality.newton_iterations = 100;
  AddBoxSet(scene, "bottom", {-1, -1, -1}, {2, 2, 1e-9});
  AddBoxSet(scene, "top", {-1, -1, 1 - 1e-9}, {2, 2, 2});
  AddMotion(scene, "bottom");
  AddMotion(scene, "top").keyframes = {
      {0, {0, 0, 0}, 0}, {0.2, {0, 0, -depth}, 0}, {0.3, {0, 0, -depth}, 0}, {0.5, {0, 0, 0}, 0}};
  return MustRun(scene, KuhnBox({3, 3, 3}, {1, 1, 1}), 300);
}

TEST_P(Hostile, ACubeCrushedToAFifthComesBack) {
  const TetMesh mesh = KuhnBox({3, 3, 3}, {1, 1, 1});
  const auto simulation = Crush(0.8);
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    for (size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(simulation->positions()[node][axis], mesh.rest_positions[node][axis], 1e-2);
  }
}

TEST_P(Hostile, ALidThroughTheFloorTurnsTetsInsideOutAndNothingDiverges) {
  const auto simulation = Crush(1.5);
  for (const Vec3& position : simulation->positions()) {
    for (const double coordinate : position) EXPECT_LT(std::abs(coordinate), 5);
  }
}

// Its forces are rounding and nothing else, which no tolerance relative to them can reach.
TEST_P(Hostile, ABodyDraggedFarAndTurnedThereComesToRestInRounding) {
  const TetMesh mesh = KuhnBox({3, 2, 2}, {1.5, 1, 1});
  Scene scene = TightScene(1e9, 0.3, 1000, 0.01);
  scene.quality = Quality{};
  AddBoxSet(scene, "end", {-1, -1, -1}, {1e-9, 2, 2});
  Motion& drag = AddMotion(scene, "end");
  drag.keyframes = {{0, {0, 0, 0}, 0}, {1, {50, 20, -30}, 2}};
  MustRun(scene, mesh, 200);
}

TEST_P(Hostile, DensityAndStiffnessAMillionTimesApart) {
  TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1});
  mesh.tet_regions.resize(static_cast<size_t>(mesh.tet_count()));
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet)
    mesh.tet_regions[tet] = mesh.rest_positions[static_cast<size_t>(mesh.tets[tet][0])][0] < 0.9;
  Scene scene = Cube();
  scene.quality.newton_iterations = 60;
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].regions = {"1"};
  scene.materials[1].youngs_modulus *= 1e6;
  scene.materials[1].density *= 1e-6;
  MustRun(scene, mesh, 10);
}

TEST_P(Hostile, PinnedEndsThatCross) {
  const TetMesh mesh = KuhnBox({6, 2, 2}, {3, 1, 1});
  Scene scene = TightScene(1e4, 0.3, 1000, 0.01);
  scene.quality = Quality{};
  scene.quality.newton_iterations = 100;
  scene.materials[0].tensile_strength = 2e3;
  AddBoxSet(scene, "left", {-1, -1, -1}, {1e-9, 2, 2});
  AddBoxSet(scene, "right", {3 - 1e-9, -1, -1}, {4, 2, 2});
  AddMotion(scene, "left");
  AddMotion(scene, "right").keyframes = {{0, {0, 0, 0}, 0}, {0.4, {-4, 0, 0}, 0}};
  MustRun(scene, mesh, 40);
}

}  // namespace
}  // namespace cleave
