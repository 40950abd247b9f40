#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include "core/material/corotated_linear.h"
#include "core/material/invertible_neo_hookean.h"
#include "core/material/st_venant_kirchhoff.h"
#include "core/material/stable_neo_hookean.h"
#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kFar = 1e6;
constexpr ElasticLaw kLaws[] = {ElasticLaw::kStableNeoHookean, ElasticLaw::kInvertibleNeoHookean,
                                ElasticLaw::kCorotatedLinear, ElasticLaw::kStVenantKirchhoff};

template <typename Law>
Vec3 PrincipalStress(const Vec3& stretch, double youngs_modulus, double poisson_ratio) {
  const auto lame = ToLame(youngs_modulus, poisson_ratio);
  Matrix3<Double4> g;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) g(i, j) = Splat(i == j ? stretch[static_cast<size_t>(i)] - 1 : 0);
  }
  const auto stress = Law::Stress(g, Law::KinematicsOf(g), {Splat(lame.mu), Splat(lame.lambda)});
  return {stress(0, 0)[0], stress(1, 1)[0], stress(2, 2)[0]};
}

// Principal first Piola-Kirchhoff stresses (Pa) at principal stretches.
Vec3 PrincipalStress(ElasticLaw law, const Vec3& stretch, double youngs_modulus,
                     double poisson_ratio) {
  switch (law) {
    case ElasticLaw::kInvertibleNeoHookean:
      return PrincipalStress<InvertibleNeoHookean>(stretch, youngs_modulus, poisson_ratio);
    case ElasticLaw::kCorotatedLinear:
      return PrincipalStress<CorotatedLinear>(stretch, youngs_modulus, poisson_ratio);
    case ElasticLaw::kStVenantKirchhoff:
      return PrincipalStress<StVenantKirchhoff>(stretch, youngs_modulus, poisson_ratio);
    case ElasticLaw::kStableNeoHookean:
      break;
  }
  return PrincipalStress<StableNeoHookean>(stretch, youngs_modulus, poisson_ratio);
}

// A bar along x from 0 to `length`, free to narrow, whose far end is pulled to `stretch`.
Scene PulledBar(double length, double stretch, double poisson_ratio) {
  Scene scene = TightScene(1, poisson_ratio, 1e-9, 1);
  AddSymmetryPlanes(scene);
  AddBoxSet(scene, "x1", {length - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  AddMotion(scene, "x1", {true, false, false}).keyframes = {{0, {0, 0, 0}, 0},
                                                            {4, {length * (stretch - 1), 0, 0}, 0}};
  return scene;
}

FrameReport Settle(Simulation& simulation) {
  const StopFlag stop;
  FrameReport last;
  for (int step = 0; step < 12; ++step) {
    auto report = simulation.Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) break;
    last = *report;
  }
  return last;
}

class PulledLaw : public ::testing::TestWithParam<std::tuple<ElasticLaw, double>> {};

TEST_P(PulledLaw, PullsWithItsStressAndIsFreeOfStressAcross) {
  const auto [law, stretch] = GetParam();
  Scene scene = PulledBar(1, stretch, 0.3);
  scene.materials[0].law = law;
  auto simulation = *Simulation::Create(scene, KuhnBox({2, 2, 2}, {1, 1, 1}), {});
  const FrameReport report = Settle(*simulation);
  const Vec3 corner = simulation->positions().back();
  const Vec3 stress = PrincipalStress(law, corner, 1, 0.3);
  EXPECT_NEAR(corner[0], stretch, 1e-12);
  EXPECT_NEAR(report.motion_forces.back()[0], stress[0], 1e-6);
  EXPECT_NEAR(stress[1], 0, 1e-6);
  EXPECT_NEAR(stress[2], 0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(AllLaws, PulledLaw,
                         ::testing::Combine(::testing::ValuesIn(kLaws),
                                            ::testing::Values(0.7, 0.95, 1.3, 1.8)));

TEST(MixedLaws, CarryOneForceThroughOneMesh) {
  constexpr double kLength = 4, kStretch = 1.3;
  Scene scene = PulledBar(kLength, kStretch, 0.3);
  // Kept from narrowing anywhere, each part is strained along the bar only.
  AddBoxSet(scene, "all", {-kFar, -kFar, -kFar}, {kFar, kFar, kFar});
  scene.motions[1].node_set = scene.motions[2].node_set = "all";
  TetMesh mesh = KuhnBox({8, 1, 1}, {kLength, 1, 1});
  mesh.tet_regions.resize(mesh.tets.size());
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet)
    mesh.tet_regions[tet] = static_cast<int32_t>(tet / 12);
  for (int32_t region = 0; region < 4; ++region)
    mesh.regions.push_back({region, "part" + std::to_string(region)});
  scene.materials.resize(4, scene.materials[0]);
  for (size_t part = 0; part < 4; ++part) {
    scene.materials[part].law = kLaws[part];
    scene.materials[part].regions = {"part" + std::to_string(part)};
  }
  auto simulation = *Simulation::Create(scene, mesh, {});
  const FrameReport report = Settle(*simulation);
  for (size_t part = 0; part < 4; ++part) {
    // Nodes of a cross-section are four; a part has two cells along the bar.
    const double begin = simulation->positions()[part * 8][0];
    const double end = simulation->positions()[part * 8 + 8][0];
    const Vec3 stress = PrincipalStress(kLaws[part], {end - begin, 1, 1}, 1, 0.3);
    EXPECT_NEAR(stress[0], report.motion_forces.back()[0], 1e-6) << part;
  }
  EXPECT_NEAR(simulation->positions().back()[0], kLength * kStretch, 1e-12);
}

}  // namespace
}  // namespace cleave
