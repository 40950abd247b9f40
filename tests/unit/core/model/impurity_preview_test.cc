#include "core/model/impurity_preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/damage/random_graph.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

Scene PlainScene() {
  Scene scene;
  Material material;
  material.youngs_modulus = 1e6;
  material.density = 1000;
  material.tensile_strength = 2000;
  scene.materials = {material};
  return scene;
}
ImpurityLayer Stroke() {
  Strokes strokes;
  strokes.curves = {{{{1.4, -1, 0}, {1.4, 9, 0}}}};
  ImpurityLayer layer;
  layer.source = strokes;
  return layer;
}
TetMesh Slab() { return KuhnBox({4, 2, 1}, {4, 2, 1}); }

TEST(ImpurityPreview, PredictsStrengthsByPotencyAndWeakening) {
  Scene scene = PlainScene();
  scene.impurities.emplace().layers = {Stroke()};
  scene.impurities->layers[0].potency = 3;
  scene.impurities->layers[0].weakening = 0.5;
  const auto preview = *PreviewImpurities(scene, Slab());
  const BondStrength bond({});
  int64_t affected = 0;
  for (size_t e = 0; e < preview.edges.size(); ++e) {
    const auto a = static_cast<size_t>(preview.edges[e][0]);
    const auto b = static_cast<size_t>(preview.edges[e][1]);
    const double xa = Slab().rest_positions[a][0], xb = Slab().rest_positions[b][0];
    EXPECT_EQ(preview.potencies[a], xa == 1 || xa == 2 ? 3 : 0);
    const bool crossed = std::min(xa, xb) == 1 && std::max(xa, xb) == 2;
    EXPECT_EQ(preview.weakenings[e], crossed ? 0.5 : 1);
    const double kappa = bond(preview.potencies[a], preview.potencies[b], 1, 1);
    EXPECT_NEAR(preview.strengths[e], 2000 * kappa * preview.weakenings[e], 1e-9);
    EXPECT_EQ(preview.affected[e] != 0, kappa < 0.999);
    affected += kappa < 0.999;
  }
  EXPECT_EQ(preview.affected_edges, affected);
  EXPECT_NEAR(preview.weakest, 1000 * bond(3, 3, 1, 1), 1e-9);
  EXPECT_NEAR(preview.strongest, 2000, 1e-9);
}

TEST(ImpurityPreview, KnowsCutsWhereNothingElseBreaksAndBodiesThatDoNot) {
  Scene scene = PlainScene();
  scene.materials[0].tensile_strength.reset();
  EXPECT_FALSE(PreviewImpurities(scene, Slab()).ok());
  scene.impurities.emplace().layers = {Stroke()};
  scene.impurities->layers[0].potency = 3;
  EXPECT_TRUE(std::isinf(PreviewImpurities(scene, Slab())->weakest));
  scene.impurities->layers[0].weakening = 0;
  const auto cut = *PreviewImpurities(scene, Slab());
  EXPECT_EQ(cut.weakest, 0);
  EXPECT_TRUE(std::isinf(cut.strongest));
}

}  // namespace
}  // namespace cleave
