#include "core/model/footprint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/model/build_model.h"
#include "core/model/edge_projected_term.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

std::vector<std::string> Names(const Footprint& footprint) {
  std::vector<std::string> names;
  for (const Part& part : footprint.parts) names.push_back(part.name);
  return names;
}

Footprint Plan(const Scene& scene) { return PlanModel(scene, 1000, 4000, 6000); }

int64_t BytesOf(const Footprint& footprint, const std::string& name) {
  for (const Part& part : footprint.parts) {
    if (part.name == name) return part.bytes;
  }
  return -1;
}

TEST(Footprint, AMinimalSceneHasTheseParts) {
  const Footprint footprint = Plan(TightScene(1e6, 0.3, 1000, 0.01));
  EXPECT_THAT(Names(footprint), ElementsAre("mesh", "incidence", "elasticity", "state",
                                            "stiffness matrix", "solver"));
  int64_t sum = 0;
  for (const Part& part : footprint.parts) sum += part.bytes;
  EXPECT_EQ(footprint.total_bytes, sum);
  EXPECT_GT(footprint.seconds_per_frame, 0);
  EXPECT_DOUBLE_EQ(footprint.total_seconds, 48 * footprint.seconds_per_frame);
}

TEST(Footprint, ARenderMeshIsNoPartOfTheModel) {
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  const Footprint bare = Plan(scene);
  scene.render_mesh = RenderMeshSource{MeshAsset{std::string(64, 'a')}, 1};
  EXPECT_EQ(Names(Plan(scene)), Names(bare));
  EXPECT_EQ(Plan(scene).total_bytes, bare.total_bytes);
}

TEST(Footprint, EachFeatureAddsItsPartAndNothingElse) {
  const Scene minimal = TightScene(1e6, 0.3, 1000, 0.01);
  const Footprint base = Plan(minimal);
  const auto expect_adds = [&](const Scene& scene, const std::string& name) {
    const Footprint footprint = Plan(scene);
    ASSERT_EQ(footprint.parts.size(), base.parts.size() + 1) << name;
    EXPECT_EQ(footprint.parts.back().name, name);
    for (size_t k = 0; k < base.parts.size(); ++k) {
      EXPECT_EQ(footprint.parts[k].name, base.parts[k].name);
      EXPECT_EQ(footprint.parts[k].bytes, base.parts[k].bytes);
    }
  };
  Scene scene = minimal;
  scene.gravity = Vec3{0, 0, -9.81};
  expect_adds(scene, "gravity");
  scene = minimal;
  scene.damping = Damping{0, 0};
  EXPECT_EQ(Plan(scene).total_bytes, base.total_bytes);
  scene.damping = Damping{1, 0};
  expect_adds(scene, "damping");
  EXPECT_EQ(BytesOf(Plan(scene), "damping"), 1000 * 80);
  scene.damping = Damping{0, 1};
  expect_adds(scene, "damping");
  EXPECT_EQ(BytesOf(Plan(scene), "damping"), 1000 * 340 + BytesOf(base, "stiffness matrix"));
  scene = minimal;
  AddMotion(scene, "any");
  expect_adds(scene, "motions");
  scene = minimal;
  scene.loads.push_back({"any", PointForce{{1, 0, 0}}, {}, {}});
  expect_adds(scene, "loads");
  EXPECT_EQ(BytesOf(Plan(scene), "loads"), 1000 * (32 + 4 + 8 + 32));
  scene.loads[0].kind = SurfacePressure{1};
  expect_adds(scene, "loads");
  scene.loads[0].release = Release{.time = 1};
  EXPECT_EQ(Names(Plan(scene)).back(), "releases");
  EXPECT_EQ(BytesOf(Plan(scene), "releases"), 1000 * 4);
  scene = minimal;
  scene.initial_velocities.emplace_back();
  expect_adds(scene, "initial velocities");
  scene = minimal;
  scene.colliders.emplace_back().shape = PlaneShape{};
  expect_adds(scene, "colliders");
  scene = minimal;
  scene.contact.emplace();
  expect_adds(scene, "contact");
  scene = minimal;
  scene.sleep.emplace();
  expect_adds(scene, "sleep");
  scene = minimal;
  scene.materials[0].tensile_strength = 1e5;
  expect_adds(scene, "fracture");
  scene = minimal;
  scene.weakenings.push_back({SphereSelector{{0, 0, 0}, 1}, 0});
  expect_adds(scene, "fracture");
  scene = minimal;
  scene.materials[0].fibres.push_back({1e6, ConstantDirection{{1, 0, 0}}, 1});
  expect_adds(scene, "fibres");
  scene = minimal;
  scene.materials[0].plasticity = Plasticity{.yield_stress = 1e4};
  expect_adds(scene, "plasticity");
  // Where nothing breaks, strengths do not exist.
  scene = minimal;
  scene.impurities = Impurities{.potency = 1};
  EXPECT_EQ(Plan(scene).total_bytes, base.total_bytes);
  scene.materials[0].tensile_strength = 1e5;
  EXPECT_EQ(Names(Plan(scene)).back(), "impurities");
  EXPECT_EQ(BytesOf(Plan(scene), "impurities"), 1000 * 12 + 6000 * 8);
  // Layers are baked: what stays is what potencies and thresholds take anyway.
  const auto pure_fracture = BytesOf(Plan(scene), "fracture");
  scene.impurities->layers.emplace_back().source = Strokes{};
  scene.impurities->layers[0].potency = 1;
  EXPECT_EQ(BytesOf(Plan(scene), "impurities"), 1000 * 12 + 6000 * 8);
  EXPECT_EQ(BytesOf(Plan(scene), "fracture"), pure_fracture);
  scene.impurities->layers[0].weakening = 0.5;
  EXPECT_EQ(BytesOf(Plan(scene), "fracture"), pure_fracture + 5999 * 8);
  scene = minimal;
  scene.materials[0].tensile_strength = 1e5;
  EXPECT_EQ(BytesOf(Plan(scene), "fatigue"), -1);
  scene.materials[0].fatigue = Fatigue{1e6, -0.1, {}, 1};
  EXPECT_EQ(Names(Plan(scene)).back(), "fatigue");
  EXPECT_EQ(BytesOf(Plan(scene), "fatigue"), 6000 * (64 + 8 + 8));
  scene = minimal;
  scene.fracture.reformulation = Reformulation::kEdgeProjected;
  EXPECT_EQ(Plan(scene).total_bytes, base.total_bytes);
  scene.materials[0].tensile_strength = 1e5;
  EXPECT_EQ(Names(Plan(scene)).back(), "edge-projected tets");
  EXPECT_EQ(BytesOf(Plan(scene), "strands"), -1);
  scene.materials[0].strands = Strands{0.1, 2};
  EXPECT_EQ(Names(Plan(scene)).back(), "strands");
  EXPECT_EQ(BytesOf(Plan(scene), "strands"), 4000 * 8);
  scene.fracture.reformulation = Reformulation::kUniform;
  EXPECT_EQ(BytesOf(Plan(scene), "strands"), 4000 * (8 + EdgeProjectedTerm::TetBytes()));
  EXPECT_EQ(BytesOf(Plan(scene), "edge-projected tets"), -1);
  scene = minimal;
  scene.materials[0].compressive_strength = 1e5;
  EXPECT_THAT(Names(Plan(scene)), Contains("fracture"));
  EXPECT_EQ(Names(Plan(scene)).back(), "compressive strength");
  EXPECT_EQ(BytesOf(Plan(scene), "compressive strength"), 8);
  scene.weakenings.push_back({SphereSelector{{0, 0, 0}, 1}, 0.5});
  EXPECT_EQ(BytesOf(Plan(scene), "compressive strength"), 6000 * 8);
}

TEST(Footprint, FibresTakeTheBytesThatWerePlanned) {
  const TetMesh mesh = KuhnBox({5, 4, 3}, {1, 1, 1});
  const FibreFamily family{1e6, ConstantDirection{{1, 0, 0}}, 1};
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
    scene.quality.precision = precision;
    const int64_t without = BuildModel(scene, mesh)->tet_terms[0]->bytes();
    scene.materials[0].fibres = {family, family};
    const Model model = *BuildModel(scene, mesh);
    ASSERT_EQ(model.tet_terms.size(), 1u);
    const Footprint footprint =
        PlanModel(scene, mesh.node_count(), mesh.tet_count(), model.incidence->edge_count());
    EXPECT_EQ(BytesOf(footprint, "fibres"), model.tet_terms[0]->bytes() - without);
  }
}

TEST(Footprint, LoadsTakeNoMoreThanWasPlanned) {
  const TetMesh mesh = KuhnBox({5, 4, 3}, {1, 1, 1});
  for (const LoadKind& kind :
       {LoadKind(PointForce{{1, 0, 0}}), LoadKind(SurfaceTraction{{1, 0, 0}}),
        LoadKind(SurfacePressure{1})}) {
    Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
    AddBoxSet(scene, "all", {-1, -1, -1}, {2, 2, 2});
    scene.loads.push_back({"all", kind, {{0, 0}, {1, 1}}, {}});
    const Model model = *BuildModel(scene, mesh);
    ASSERT_EQ(model.node_terms.size(), 1u);
    const Footprint footprint =
        PlanModel(scene, mesh.node_count(), mesh.tet_count(), model.incidence->edge_count());
    EXPECT_GT(model.node_terms[0]->bytes(), 0);
    EXPECT_GE(BytesOf(footprint, "loads"), model.node_terms[0]->bytes());
  }
}

TEST(Footprint, ASecondMaterialCostsARecordABatch) {
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  const int64_t uniform = BytesOf(Plan(scene), "elasticity");
  scene.materials.push_back(scene.materials[0]);
  EXPECT_EQ(BytesOf(Plan(scene), "elasticity") - uniform, (4000 / 4 - 1) * 64);
}

TEST(Footprint, ElasticityTakesTheBytesThatWerePlanned) {
  const TetMesh mesh = KuhnBox({5, 4, 3}, {1, 1, 1});
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
    scene.quality.precision = precision;
    for (int materials = 1; materials <= 2; ++materials) {
      const Model model = *BuildModel(scene, mesh);
      const Footprint footprint =
          PlanModel(scene, mesh.node_count(), mesh.tet_count(), model.incidence->edge_count());
      EXPECT_EQ(BytesOf(footprint, "elasticity"), model.tet_terms[0]->bytes());
      scene.materials.push_back(scene.materials[0]);
    }
  }
}

TEST(Footprint, PlasticityTakesTheBytesThatWerePlanned) {
  const TetMesh mesh = KuhnBox({5, 4, 3}, {1, 1, 1});
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
    scene.quality.precision = precision;
    scene.materials[0].plasticity = Plasticity{.yield_stress = 1e4};
    const Model model = *BuildModel(scene, mesh);
    ASSERT_EQ(model.plastic_terms.size(), 1u);
    EXPECT_EQ(model.tet_terms.size(), 1u);
    const Footprint footprint =
        PlanModel(scene, mesh.node_count(), mesh.tet_count(), model.incidence->edge_count());
    EXPECT_EQ(BytesOf(footprint, "plasticity") + BytesOf(footprint, "elasticity"),
              model.tet_terms[0]->bytes());
  }
}

TEST(BuildModel, MakesOnlyWhatTheSceneAsksFor) {
  const TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1});
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  const Model minimal = *BuildModel(scene, mesh);
  EXPECT_FALSE(minimal.gravity.has_value());
  EXPECT_FALSE(minimal.fracture.has_value());
  EXPECT_TRUE(minimal.motions.empty());
  EXPECT_TRUE(minimal.node_terms.empty());
  EXPECT_TRUE(minimal.releases.empty());
  EXPECT_EQ(minimal.tet_terms.size(), 1u);
  EXPECT_TRUE(minimal.plastic_terms.empty());
  EXPECT_FALSE(minimal.fibrous);
  EXPECT_FALSE(minimal.damping.has_value());
  EXPECT_FALSE(minimal.sleep.has_value());
  EXPECT_EQ(minimal.colliders, nullptr);
  double mass = 0;
  for (const double of_node : minimal.masses) mass += of_node;
  EXPECT_NEAR(mass, 1000, 1e-9);

  scene.materials[0].tensile_strength = 1e5;
  const Model breaking = *BuildModel(scene, mesh);
  ASSERT_TRUE(breaking.fracture.has_value());
  EXPECT_EQ(breaking.fracture->edge_thresholds, std::vector<double>{1e5});
  EXPECT_TRUE(breaking.fracture->compressive_thresholds.empty());
  EXPECT_EQ(breaking.fracture->edge_projected, nullptr);
  EXPECT_FALSE(breaking.fracture->impurities.has_value());
  EXPECT_FALSE(breaking.fracture->fatigue.has_value());
  EXPECT_FALSE(breaking.fracture->strands.has_value());
  EXPECT_EQ(breaking.tet_terms.size(), 1u);
  EXPECT_EQ(breaking.tet_terms[0]->bytes(), minimal.tet_terms[0]->bytes());
  // Client edge ids are a renumbering that leads to the same nodes.
  const Incidence incidence = BuildIncidence(mesh);
  for (size_t edge = 0; edge < breaking.incidence->edges.size(); ++edge) {
    auto ends = breaking.incidence->edges[edge];
    for (int32_t& end : ends) end = breaking.order.old_node[static_cast<size_t>(end)];
    std::sort(ends.begin(), ends.end());
    EXPECT_EQ(incidence.edges[static_cast<size_t>(breaking.fracture->client_edge[edge])], ends);
  }
}

TEST(BuildModel, RefusesATetWithoutMaterial) {
  TetMesh mesh = KuhnBox({1, 1, 1}, {1, 1, 1});
  mesh.tet_regions.assign(6, 3);
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  scene.materials[0].regions = {"4"};
  EXPECT_EQ(BuildModel(scene, mesh).status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace cleave
