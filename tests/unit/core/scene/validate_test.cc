#include "core/scene/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace cleave {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Scene GoodScene() {
  Scene scene;
  BoxMesh box;
  box.size = {1, 1, 1};
  box.resolution.cell_size = 0.25;
  scene.mesh.source = box;
  Material material;
  material.youngs_modulus = 1e6;
  material.poisson_ratio = 0.3;
  material.density = 1000;
  scene.materials = {material};
  scene.node_sets = {{"left", {PlaneSelector{{0, 0, 0}, {-1, 0, 0}}}}};
  Motion pull;
  pull.node_set = "left";
  pull.keyframes = {{0, {0, 0, 0}, 0}, {1, {-0.1, 0, 0}, 0}};
  scene.motions = {pull};
  return scene;
}

// Spoils one thing of a good scene and says which field must be named.
struct Case {
  const char* field;
  std::function<void(Scene&)> spoil;
};

TEST(ValidateScene, AcceptsAGoodSceneWithoutAWord) {
  const Faults faults = ValidateScene(GoodScene());
  EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  EXPECT_EQ(faults.warning_count(), 0);
}

FibreFamily FibresAlong(FibreDirection direction) {
  FibreFamily family;
  family.stiffness = 1e6;
  family.direction = std::move(direction);
  return family;
}

TEST(ValidateScene, NamesTheFieldOfEveryKindOfFault) {
  const auto fibres = [](FibreDirection direction) {
    return [direction](Scene& s) { s.materials[0].fibres = {FibresAlong(direction)}; };
  };
  const std::vector<Case> cases = {
      {"weakenings[0]", [](Scene& s) { s.weakenings.emplace_back(); }},
      {"weakenings[0].node_set",
       [](Scene& s) {
         s.weakenings = {{EdgesOfNodes{"crumbs"}, 1}};
       }},
      {"weakenings[0].sphere.radius",
       [](Scene& s) {
         s.weakenings = {{SphereSelector{{0, 0, 0}, -1}, 1}};
       }},
      {"weakenings[0].box.min[2]",
       [](Scene& s) {
         s.weakenings = {{BoxSelector{{0, 0, 1}, {1, 1, 0}}, 1}};
       }},
      {"weakenings[0].factor",
       [](Scene& s) {
         s.weakenings = {{EdgesOfNodes{"left"}, kNan}};
       }},
      {"impurities.potency", [](Scene& s) { s.impurities = Impurities{.potency = 101}; }},
      {"impurities.noise", [](Scene& s) { s.impurities = Impurities{.noise = kNan}; }},
      {"impurities.map[1]",
       [](Scene& s) {
         s.impurities = Impurities{.map = {0, 2}};
       }},
      {"impurities.patches[0].node_set",
       [](Scene& s) {
         s.impurities = Impurities{.patches = {{"crumbs", 1}}};
       }},
      {"impurities.patches[0].share",
       [](Scene& s) {
         s.impurities = Impurities{.patches = {{"left", -1}}};
       }},
      {"impurities.patches",
       [](Scene& s) {
         s.impurities = Impurities{.map = {0.5}, .patches = {{"left", 1}}};
       }},
      {"impurities.steepness", [](Scene& s) { s.impurities = Impurities{.steepness = 0}; }},
      {"impurities.pure_offset", [](Scene& s) { s.impurities = Impurities{.pure_offset = 0}; }},
      {"impurities.degree_weight", [](Scene& s) { s.impurities = Impurities{.degree_weight = 2}; }},
      {"materials[0].plasticity.yield_stress",
       [](Scene& s) { s.materials[0].plasticity = Plasticity{.yield_stress = 0}; }},
      {"materials[0].plasticity.hardening",
       [](Scene& s) {
         s.materials[0].plasticity = Plasticity{.yield_stress = 1e5, .hardening = kInf};
       }},
      {"materials[0].plasticity.flow_rate",
       [](Scene& s) {
         s.materials[0].plasticity = Plasticity{.yield_stress = 1e5, .flow_rate = 0};
       }},
      {"materials[0].plasticity.failure_strain",
       [](Scene& s) {
         s.materials[0].tensile_strength = 2e5;
         s.materials[0].plasticity = Plasticity{.yield_stress = 1e5, .failure_strain = kNan};
       }},
      {"materials[0].plasticity.failure_strain",
       [](Scene& s) {
         s.materials[0].plasticity = Plasticity{.yield_stress = 1e5, .failure_strain = 0.1};
       }},
      {"materials[0].fibres[0]", fibres(std::monostate())},
      {"materials[0].fibres", [](Scene& s) { s.materials[0].fibres.resize(5); }},
      {"materials[0].fibres[0].stiffness",
       [](Scene& s) {
         s.materials[0].fibres = {FibresAlong(ConstantDirection{{1, 0, 0}})};
         s.materials[0].fibres[0].stiffness = -1;
       }},
      {"materials[0].fibres[0].strength_ratio",
       [](Scene& s) {
         s.materials[0].fibres = {FibresAlong(ConstantDirection{{1, 0, 0}})};
         s.materials[0].fibres[0].strength_ratio = 0.5;
       }},
      {"materials[0].fibres[0].constant.vector", fibres(ConstantDirection{{0, 0, 0}})},
      {"materials[0].fibres[0].constant.vector[1]", fibres(ConstantDirection{{1, kNan, 0}})},
      {"materials[0].fibres[0].cylindrical.axis",
       fibres(CylindricalDirection{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}})},
      {"materials[0].fibres[0].cylindrical.mixture",
       fibres(CylindricalDirection{{0, 0, 0}, {0, 0, 1}, {0, 0, 0}})},
      {"materials[0].fibres[0].per_tet.vectors[1]", fibres(TetDirections{{{1, 0, 0}, {0, 0, 0}}})},
      {"materials[0].fibres[0].curves.curves", fibres(CurveDirections{})},
      {"materials[0].fibres[0].curves.curves[0].points",
       fibres(CurveDirections{{Polyline{{{1, 0, 0}}}}})},
      {"mesh", [](Scene& s) { s.mesh.source = std::monostate(); }},
      {"mesh.file", [](Scene& s) { s.mesh.source = MeshFile{"bar.msh"}; }},
      {"mesh.asset", [](Scene& s) { s.mesh.source = MeshAsset{"abc"}; }},
      {"mesh.unit_scale", [](Scene& s) { s.mesh.unit_scale = 0; }},
      {"mesh.box.size[1]", [](Scene& s) { std::get<BoxMesh>(s.mesh.source).size[1] = -1; }},
      {"mesh.box.origin[2]", [](Scene& s) { std::get<BoxMesh>(s.mesh.source).origin[2] = kNan; }},
      {"mesh.box.resolution.cell_size",
       [](Scene& s) { std::get<BoxMesh>(s.mesh.source).resolution.cell_size = kInf; }},
      {"mesh.box.resolution.cell_size",
       [](Scene& s) { std::get<BoxMesh>(s.mesh.source).resolution.cell_size = 1e-7; }},
      {"mesh.box.resolution.jitter",
       [](Scene& s) { std::get<BoxMesh>(s.mesh.source).resolution.jitter = 0.5; }},
      {"mesh.tube.inner_radius",
       [](Scene& s) {
         TubeMesh tube;
         tube.outer_radius = tube.inner_radius = tube.height = tube.resolution.cell_size = 1;
         s.mesh.source = tube;
       }},
      {"materials", [](Scene& s) { s.materials.clear(); }},
      {"materials", [](Scene& s) { s.materials.resize(100'000, s.materials[0]); }},
      {"materials[0].youngs_modulus", [](Scene& s) { s.materials[0].youngs_modulus = 0; }},
      {"materials[0].youngs_modulus", [](Scene& s) { s.materials[0].youngs_modulus = kNan; }},
      {"materials[0].poisson_ratio", [](Scene& s) { s.materials[0].poisson_ratio = 0.52; }},
      {"materials[0].poisson_ratio", [](Scene& s) { s.materials[0].poisson_ratio = -0.1; }},
      {"materials[0].density", [](Scene& s) { s.materials[0].density = -3; }},
      {"materials[0].tensile_strength", [](Scene& s) { s.materials[0].tensile_strength = -1; }},
      {"materials[0].tensile_strength", [](Scene& s) { s.materials[0].tensile_strength = kNan; }},
      {"materials[0].fatigue",
       [](Scene& s) {
         s.materials[0].fatigue = Fatigue{1e6, -0.1, {}, 1};
       }},
      {"materials[0].fatigue.strength_coefficient",
       [](Scene& s) {
         s.materials[0].tensile_strength = 1e5;
         s.materials[0].fatigue = Fatigue{0, -0.1, {}, 1};
       }},
      {"materials[0].fatigue.strength_exponent",
       [](Scene& s) {
         s.materials[0].tensile_strength = 1e5;
         s.materials[0].fatigue = Fatigue{1e6, 0.1, {}, 1};
       }},
      {"materials[0].fatigue.endurance_limit",
       [](Scene& s) {
         s.materials[0].tensile_strength = 1e5;
         s.materials[0].fatigue = Fatigue{1e6, -0.1, kNan, 1};
       }},
      {"materials[0].fatigue.degradation_exponent",
       [](Scene& s) {
         s.materials[0].tensile_strength = 1e5;
         s.materials[0].fatigue = Fatigue{1e6, -0.1, {}, 0};
       }},
      {"materials[0].strands",
       [](Scene& s) {
         s.materials[0].tensile_strength.reset();
         s.materials[0].strands = Strands{0.1, 2};
       }},
      {"materials[0].strands",
       [](Scene& s) {
         s.materials[0].tensile_strength = 1e5;
         s.materials[0].plasticity = Plasticity{.yield_stress = 1e4, .hardening = 1e5};
         s.materials[0].strands = Strands{0.1, 2};
       }},
      {"materials[0].strands.residual_factor",
       [](Scene& s) {
         s.materials[0].tensile_strength = 1e5;
         s.materials[0].strands = Strands{1, 2};
       }},
      {"materials[0].strands.stretch_limit",
       [](Scene& s) {
         s.materials[0].tensile_strength = 1e5;
         s.materials[0].strands = Strands{0.1, 1};
       }},
      {"materials[0].compressive_strength",
       [](Scene& s) { s.materials[0].compressive_strength = 0; }},
      {"node_sets[0].name", [](Scene& s) { s.node_sets[0].name = std::string(500, 'x'); }},
      {"node_sets[1].name", [](Scene& s) { s.node_sets.push_back(s.node_sets[0]); }},
      {"node_sets[0].select", [](Scene& s) { s.node_sets[0].select.clear(); }},
      {"node_sets[0].select[0]", [](Scene& s) { s.node_sets[0].select[0] = std::monostate(); }},
      {"node_sets[0].select[0].plane.normal",
       [](Scene& s) {
         s.node_sets[0].select[0] = PlaneSelector{{0, 0, 0}, {0, 0, 0}};
       }},
      {"node_sets[0].select[0].box.min[0]",
       [](Scene& s) {
         s.node_sets[0].select[0] = BoxSelector{{2, 0, 0}, {1, 1, 1}};
       }},
      {"node_sets[0].select[0].sphere.radius",
       [](Scene& s) {
         s.node_sets[0].select[0] = SphereSelector{{0, 0, 0}, 0};
       }},
      {"motions[0].node_set", [](Scene& s) { s.motions[0].node_set = "right"; }},
      {"motions[0].keyframes[1].time", [](Scene& s) { s.motions[0].keyframes[1].time = 0; }},
      {"motions[0].keyframes[1].translation[0]",
       [](Scene& s) { s.motions[0].keyframes[1].translation[0] = kInf; }},
      {"motions[0].rotation_axis",
       [](Scene& s) {
         s.motions[0].rotation_axis = {0, 0, 0};
       }},
      {"motions[0].axes",
       [](Scene& s) {
         s.motions[0].axes = {true, false, false};
         s.motions[0].keyframes[1].rotation = 1;
       }},
      {"initial_velocities[0].node_set",
       [](Scene& s) {
         s.initial_velocities = {{"nowhere", {}, {}, {}}};
       }},
      {"initial_velocities[0].velocity[1]",
       [](Scene& s) {
         s.initial_velocities = {{"", {0, kNan, 0}, {}, {}}};
       }},
      {"motions[0].release", [](Scene& s) { s.motions[0].release = Release{}; }},
      {"motions[0].release.time", [](Scene& s) { s.motions[0].release = Release{.time = kNan}; }},
      {"motions[0].release.broken_share",
       [](Scene& s) { s.motions[0].release = Release{.broken_share = 0}; }},
      {"motions[0].release.pieces", [](Scene& s) { s.motions[0].release = Release{.pieces = 1}; }},
      {"motions[0].release.separated_node_sets",
       [](Scene& s) { s.motions[0].release = Release{.separated_node_sets = {"left"}}; }},
      {"motions[0].release.separated_node_sets[1]",
       [](Scene& s) {
         s.motions[0].release = Release{.separated_node_sets = {"left", "left"}};
       }},
      {"motions[0].release.separated_node_sets[1]",
       [](Scene& s) {
         s.motions[0].release = Release{.separated_node_sets = {"left", "right"}};
       }},
      {"loads[0].node_set", [](Scene& s) { s.loads = {{"right", PointForce{}, {}, {}}}; }},
      {"loads[0]", [](Scene& s) { s.loads = {{"left", std::monostate(), {}, {}}}; }},
      {"loads[0].force.total[1]",
       [](Scene& s) { s.loads = {{"left", PointForce{{0, 1e16, 0}}, {}, {}}}; }},
      {"loads[0].traction.traction[2]",
       [](Scene& s) { s.loads = {{"left", SurfaceTraction{{0, 0, kNan}}, {}, {}}}; }},
      {"loads[0].pressure.pressure",
       [](Scene& s) { s.loads = {{"left", SurfacePressure{kInf}, {}, {}}}; }},
      {"loads[0].keyframes[1].time",
       [](Scene& s) { s.loads = {{"left", SurfacePressure{1}, {{1, 1}, {1, 2}}, {}}}; }},
      {"loads[0].keyframes[0].intensity",
       [](Scene& s) { s.loads = {{"left", SurfacePressure{1}, {{1, kInf}}, {}}}; }},
      {"loads[0].release", [](Scene& s) { s.loads = {{"left", PointForce{}, {}, Release{}}}; }},
      {"gravity[2]",
       [](Scene& s) {
         s.gravity = Vec3{0, 0, kInf};
       }},
      {"fracture.max_passes", [](Scene& s) { s.fracture.max_passes = 0; }},
      {"fracture.simultaneity", [](Scene& s) { s.fracture.simultaneity = 1.5; }},
      {"fracture.reformulation",
       [](Scene& s) {
         s.materials[0].plasticity = Plasticity{1e4, 1e5};
         s.fracture.reformulation = Reformulation::kEdgeProjected;
       }},
      {"timing.frames_per_second", [](Scene& s) { s.timing.frames_per_second = 0; }},
      {"timing.frame_count", [](Scene& s) { s.timing.frame_count = -1; }},
      {"timing.steps_per_frame", [](Scene& s) { s.timing.steps_per_frame = 0; }},
      {"timing.steps_per_frame",
       [](Scene& s) {
         s.timing.frames_per_second = 0.01;
         s.timing.steps_per_frame = 1;
       }},
      {"damping.mass_coefficient", [](Scene& s) { s.damping = Damping{-1, 0}; }},
      {"damping.stiffness_coefficient", [](Scene& s) { s.damping = Damping{0, kInf}; }},
      {"quality.newton_iterations", [](Scene& s) { s.quality.newton_iterations = 0; }},
      {"quality.residual_tolerance", [](Scene& s) { s.quality.residual_tolerance = 1; }},
      {"quality.step_tolerance", [](Scene& s) { s.quality.step_tolerance = 0; }},
      {"quality.linear_tolerance", [](Scene& s) { s.quality.linear_tolerance = kNan; }},
      {"quality.max_step_halvings", [](Scene& s) { s.quality.max_step_halvings = 21; }},
      {"output.tolerance", [](Scene& s) { s.output.tolerance = -1e-9; }},
      {"output.keyframe_interval", [](Scene& s) { s.output.keyframe_interval = 0; }},
      {"output.checkpoint_interval", [](Scene& s) { s.output.checkpoint_interval = -5; }},
  };
  for (const Case& spoiled : cases) {
    Scene scene = GoodScene();
    spoiled.spoil(scene);
    const Faults faults = ValidateScene(scene);
    ASSERT_GE(faults.errors().size(), 1u) << spoiled.field;
    EXPECT_EQ(faults.errors()[0].field, spoiled.field) << faults.ToStatus();
  }
}

TEST(ValidateScene, ReportsAllFaultsAtOnceWithValueAndRange) {
  Scene scene = GoodScene();
  scene.materials[0].poisson_ratio = 0.52;
  scene.timing.frame_count = 0;
  scene.damping = Damping{kNan, 101};
  const absl::Status status = ValidateScene(scene).ToStatus();
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("materials[0].poisson_ratio: 0.52 is outside [0, 0.4999]"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("timing.frame_count: 0 is outside"));
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("damping.mass_coefficient: nan is outside [0, 1e+06]"));
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("damping.stiffness_coefficient: 101 is outside [0, 100]"));
}

TEST(ValidateScene, WarnsWhereTheResultWillBePoor) {
  Scene scene = GoodScene();
  scene.materials[0].poisson_ratio = 0.47;
  scene.materials[0].tensile_strength = 1e9;
  scene.timing.frames_per_second = 1;
  scene.materials[0].fibres = {FibresAlong(ConstantDirection{{0, 2, 0}})};
  scene.materials[0].fibres[0].stiffness = 1e12;
  const Faults faults = ValidateScene(scene);
  EXPECT_TRUE(faults.ok());
  EXPECT_EQ(faults.warning_count(), 5);
}

TEST(ValidateScene, WarnsWhereDuctilityChangesNothing) {
  Scene scene = GoodScene();
  scene.materials[0].tensile_strength = 2e5;
  Plasticity& plasticity = scene.materials[0].plasticity.emplace();
  const auto warnings = [&] {
    const Faults faults = ValidateScene(scene);
    EXPECT_TRUE(faults.ok()) << faults.ToStatus();
    return faults.warning_count();
  };
  plasticity = {.yield_stress = 2e5, .hardening = 1e5};
  EXPECT_EQ(warnings(), 1);  // breaks before it yields
  plasticity = {.yield_stress = 1e5};
  EXPECT_EQ(warnings(), 1);  // yields for ever
  plasticity.failure_strain = 0.3;
  EXPECT_EQ(warnings(), 0);
  plasticity = {.yield_stress = 1e5, .hardening = 1e5};
  EXPECT_EQ(warnings(), 0);
  plasticity = {.yield_stress = 1e5};
  scene.materials[0].tensile_strength.reset();
  EXPECT_EQ(warnings(), 0);  // nothing was to break
}

TEST(ValidateScene, WarnsOfAReleaseThatNothingCanBring) {
  Scene scene = GoodScene();
  scene.motions[0].release = Release{.first_fracture = true};
  EXPECT_TRUE(ValidateScene(scene).ok());
  ASSERT_EQ(ValidateScene(scene).warning_count(), 1);
  EXPECT_EQ(ValidateScene(scene).warnings()[0].field, "motions[0].release");
  scene.materials[0].tensile_strength = 1e4;
  EXPECT_EQ(ValidateScene(scene).warning_count(), 0);
}

TEST(ValidateScene, AcceptsInfiniteStrengthAndHalfSpaces) {
  Scene scene = GoodScene();
  scene.materials[0].tensile_strength = kInf;
  scene.node_sets[0].select = {BoxSelector{{-kInf, -kInf, -kInf}, {0, kInf, kInf}}};
  EXPECT_TRUE(ValidateScene(scene).ok());
}

TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

TEST(ValidateSceneWithMesh, AcceptsAGoodScene) {
  EXPECT_TRUE(ValidateSceneWithMesh(GoodScene(), OneTet()).ok());
}

TEST(ValidateSceneWithMesh, NamesTheFieldOfEveryKindOfFault) {
  const std::vector<Case> cases = {
      {"materials[0].regions[0]", [](Scene& s) { s.materials[0].regions = {"crust"}; }},
      {"node_sets[0].select[0].region",
       [](Scene& s) { s.node_sets[0].select[0] = RegionSelector{"crust"}; }},
      {"node_sets[0].select[0].ids.ids[1]",
       [](Scene& s) {
         s.node_sets[0].select[0] = IdSelector{{0, 4}};
       }},
      {"node_sets[0]",
       [](Scene& s) {
         s.node_sets[0].select[0] = SphereSelector{{9, 9, 9}, 1};
       }},
      {"motions[1].node_set", [](Scene& s) { s.motions.push_back(s.motions[0]); }},
      {"loads[0].node_set",
       [](Scene& s) {
         s.node_sets.push_back({"edge", {IdSelector{{0, 1}}}});
         s.loads = {{"edge", SurfacePressure{1}, {}, {}}};
       }},
      {"loads[0].release.separated_node_sets[1]",
       [](Scene& s) {
         s.node_sets.push_back({"corner", {IdSelector{{0, 1}}}});
         s.loads = {{"left", PointForce{}, {}, Release{.separated_node_sets = {"left", "corner"}}}};
       }},
      {"impurities.map",
       [](Scene& s) {
         s.impurities = Impurities{.map = {0, 1}};
       }},
      {"materials[0].fibres[0].per_tet.vectors",
       [](Scene& s) {
         s.materials[0].fibres = {FibresAlong(TetDirections{{{1, 0, 0}, {0, 1, 0}}})};
       }},
  };
  for (const Case& spoiled : cases) {
    Scene scene = GoodScene();
    spoiled.spoil(scene);
    const Faults faults = ValidateSceneWithMesh(scene, OneTet());
    ASSERT_GE(faults.errors().size(), 1u) << spoiled.field;
    EXPECT_EQ(faults.errors()[0].field, spoiled.field) << faults.ToStatus();
  }
}

TEST(ValidateSceneWithMesh, NamesRegionsWithoutAMaterial) {
  TetMesh mesh = OneTet();
  mesh.tet_regions = {3};
  Scene scene = GoodScene();
  scene.materials[0].regions = {"4"};
  const absl::Status status = ValidateSceneWithMesh(scene, mesh).ToStatus();
  EXPECT_THAT(std::string(status.message()), HasSubstr("region 3 (1 tets) has no material"));
}

TEST(ValidateSceneWithMesh, LetsTwoMotionsShareNodesOnDifferentAxes) {
  Scene scene = GoodScene();
  scene.motions.push_back(scene.motions[0]);
  scene.motions[0].axes = {true, false, false};
  scene.motions[1].axes = {false, true, true};
  EXPECT_TRUE(ValidateSceneWithMesh(scene, OneTet()).ok());
}

}  // namespace
}  // namespace cleave
