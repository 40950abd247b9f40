#include "core/solver/breaking.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "core/model/build_model.h"
#include "core/model/footprint.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

const TetMesh& Mesh() {
  static const TetMesh mesh = KuhnBox({5, 4, 3}, {1, 1, 1});
  return mesh;
}

Scene BrittleScene() {
  Scene scene = TightScene(1e6, 0.3, 1000, 0.01);
  scene.materials[0].tensile_strength = 1e5;
  return scene;
}

int64_t BytesOf(const Scene& scene) {
  const Model model = *BuildModel(scene, Mesh());
  return Breaking(model).bytes();
}

// Of the part that has this name; -1 where the scene has none.
int64_t PlannedBytes(const Scene& scene, const std::string& name) {
  const Model model = *BuildModel(scene, Mesh());
  const Footprint footprint =
      PlanModel(scene, Mesh().node_count(), Mesh().tet_count(), model.incidence->edge_count());
  for (const Part& part : footprint.parts) {
    if (part.name == name) return part.bytes;
  }
  return -1;
}

TEST(Breaking, TakesNoMoreThanWasPlannedForFracture) {
  const int64_t bytes = BytesOf(BrittleScene());
  EXPECT_GT(bytes, 0);
  EXPECT_LE(bytes, PlannedBytes(BrittleScene(), "fracture"));
}

TEST(Breaking, ImpuritiesAddTheBytesThatWerePlannedAndNoneWhereTheyDoNotCount) {
  const Scene pure = BrittleScene();
  Scene impure = pure;
  impure.impurities = Impurities{.potency = 1, .noise = 0.5};
  const Model model = *BuildModel(impure, Mesh());
  const auto potencies =
      static_cast<int64_t>(model.fracture->impurities->potencies.size() * sizeof(double));
  EXPECT_EQ(PlannedBytes(impure, "impurities"), BytesOf(impure) - BytesOf(pure) + potencies);
  impure.impurities->model = ImpurityModel::kOff;
  EXPECT_EQ(PlannedBytes(impure, "impurities"), -1);
  EXPECT_EQ(BytesOf(impure), BytesOf(pure));
}

TEST(Breaking, FatigueAddsTheBytesThatWerePlanned) {
  Scene tired = BrittleScene();
  tired.materials[0].fatigue = Fatigue{1e6, -0.1, {}, 1};
  EXPECT_EQ(PlannedBytes(tired, "fatigue"), BytesOf(tired) - BytesOf(BrittleScene()));
}

}  // namespace
}  // namespace cleave
