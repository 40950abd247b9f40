#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/simulation/run_frames.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kFar = 1e6;

// A unit cube of E = 1 Pa, nu = 0.3, pulled along x, free to narrow.
Scene PulledCube(double strain) {
  Scene scene = TightScene(1, 0.3, 1e-9, 1);
  AddSymmetryPlanes(scene);
  AddBoxSet(scene, "x1", {1 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  AddMotion(scene, "x1", {true, false, false}).keyframes = {{0, {0, 0, 0}, 0},
                                                            {10, {strain, 0, 0}, 0}};
  return scene;
}

FibreFamily Fibres(double stiffness, const Vec3& direction) {
  FibreFamily family;
  family.stiffness = stiffness;
  family.direction = ConstantDirection{direction};
  return family;
}

double ModulusWith(const std::vector<FibreFamily>& fibres) {
  constexpr double kStrain = 1e-6;
  Scene scene = PulledCube(kStrain);
  scene.materials[0].fibres = fibres;
  auto simulation = *Simulation::Create(scene, KuhnBox({2, 2, 2}, {1, 1, 1}), {});
  return RunFrames(*simulation, 14).motion_forces.back()[0] / kStrain;
}

TEST(Fibres, AddTheirStiffnessAlongAndLittleAcross) {
  EXPECT_NEAR(ModulusWith({}), 1, 1e-5);
  EXPECT_NEAR(ModulusWith({Fibres(3, {1, 0, 0})}), 4, 1e-5);
  EXPECT_NEAR(ModulusWith({Fibres(3, {0, 1, 0})}), 1.0723860589812333, 1e-5);
}

TEST(Fibres, FamiliesAddUp) {
  EXPECT_NEAR(ModulusWith({Fibres(1, {1, 0, 0}), Fibres(2, {-1, 0, 0})}), 4, 1e-5);
  // Two families at right angles hold each other's narrowing.
  EXPECT_GT(ModulusWith({Fibres(3, {1, 0, 0}), Fibres(3, {0, 1, 0})}), 4.07);
}

TEST(Fibres, StiffenOnlyTheirOwnMaterial) {
  Scene scene = PulledCube(0);
  TetMesh mesh = KuhnBox({2, 1, 1}, {1, 1, 1});
  mesh.tet_regions.assign(mesh.tets.size(), 0);
  for (size_t tet = 6; tet < 12; ++tet) mesh.tet_regions[tet] = 1;
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].regions = {"1"};
  scene.materials[1].fibres = {Fibres(3, {1, 0, 0})};
  AddBoxSet(scene, "all", {-kFar, -kFar, -kFar}, {kFar, kFar, kFar});
  scene.motions[1].node_set = scene.motions[2].node_set = "all";
  scene.motions[3].keyframes = {{0, {0, 0, 0}, 0}, {10, {1e-6, 0, 0}, 0}};
  auto simulation = *Simulation::Create(scene, mesh, {});
  RunFrames(*simulation, 14);
  // Springs in a row under uniaxial strain: lambda + 2 mu, and that plus 3.
  const double soft = 0.7 / (1.3 * 0.4), hard = soft + 3;
  EXPECT_NEAR((simulation->positions()[4][0] - 0.5) / 1e-6, hard / (soft + hard), 1e-5);
}

// The frame in which a cube pulled along its fibres first breaks.
int64_t FirstBreak(FractureStress stress, double strength_ratio) {
  Scene scene = PulledCube(0.2);
  scene.materials[0].tensile_strength = 0.04;
  scene.materials[0].fibres = {Fibres(3, {1, 0, 0})};
  scene.materials[0].fibres[0].strength_ratio = strength_ratio;
  scene.fracture.stress = stress;
  auto simulation = *Simulation::Create(scene, KuhnBox({2, 2, 2}, {1, 1, 1}), {});
  const StopFlag stop;
  for (int64_t frame = 1; frame <= 10; ++frame) {
    const auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok() || report->broken_edges > 0) return frame;
  }
  return -1;
}

TEST(Fibres, TheMatrixBreaksUnderItsOwnStressUnlessTheTotalIsAskedFor) {
  // Frame n holds a strain of 0.02 n: the matrix reaches 0.04 Pa in frame 3 (it softens), the four
  // times larger total in frame 1, and a strength twice as large along the fibres in frame 5.
  EXPECT_EQ(FirstBreak(FractureStress::kMatrix, 1), 3);
  EXPECT_EQ(FirstBreak(FractureStress::kTotal, 1), 1);
  EXPECT_EQ(FirstBreak(FractureStress::kMatrix, 2), 5);
}

TEST(Fibres, ABodyThatIsTurnedInsideOutComesBack) {
  Scene scene = TightScene(1e4, 0.3, 1000, 0.03);
  scene.quality.residual_tolerance = 1e-4;
  scene.quality.step_tolerance = 1e-4;
  scene.quality.linear_tolerance = 1e-3;
  scene.materials[0].fibres = {Fibres(5e4, {1, 0, 0}), Fibres(5e4, {0.6, 0.8, 0})};
  AddBoxSet(scene, "x0", {-kFar, -kFar, -kFar}, {1e-9, kFar, kFar});
  AddBoxSet(scene, "x1", {1 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  AddMotion(scene, "x0");
  // The far end is driven through the near one and back.
  AddMotion(scene, "x1").keyframes = {
      {0, {0, 0, 0}, 0}, {0.3, {-1.5, 0, 0}, 0}, {0.6, {0, 0, 0}, 0}};  // thousands of J on the way
  auto simulation = *Simulation::Create(scene, KuhnBox({3, 2, 2}, {1, 1, 1}), {});
  const FrameReport report = RunFrames(*simulation, 300);
  EXPECT_EQ(report.frame, 300);
  EXPECT_LT(report.elastic_energy, 0.1);
}

}  // namespace
}  // namespace cleave
