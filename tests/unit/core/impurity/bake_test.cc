#include "core/impurity/bake.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mesh/incidence.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

class Bake : public ::testing::Test {
 protected:
  Bake() {
    scene_.impurities.emplace();
    scene_.seed = 5;
  }
  ImpurityLayer& Add(ImpuritySource source, Blend blend = Blend::kMax) {
    ImpurityLayer& layer = scene_.impurities->layers.emplace_back();
    layer.source = std::move(source);
    layer.blend = blend;
    return layer;
  }
  BakedImpurities Run() const { return BakeImpurities(scene_, mesh_, incidence_.edges); }
  // Shares of a node: its x over 4.
  NodeValues Ramp() const {
    NodeValues values;
    for (const Vec3& point : mesh_.rest_positions) values.shares.push_back(point[0] / 4);
    return values;
  }
  // A knife through x = 2.5, along y.
  static Strokes Knife() {
    Strokes strokes;
    strokes.curves = {{{{2.5, -1, 0}, {2.5, 1.2, 3}, {2.5, 9, 0}}}};
    return strokes;
  }
  size_t NodeAt(int x, int y, int z) const { return static_cast<size_t>((x * 4 + y) * 4 + z); }

  const TetMesh mesh_ = KuhnBox({4, 3, 3}, {4, 3, 3});
  const Incidence incidence_ = BuildIncidence(mesh_);
  Scene scene_;
};

TEST_F(Bake, WithoutLayersGivesMapAndNoise) {
  scene_.impurities->potency = 3;
  BakedImpurities baked = Run();
  EXPECT_TRUE(std::all_of(baked.potencies.begin(), baked.potencies.end(),
                          [](double potency) { return potency == 3; }));
  EXPECT_TRUE(baked.edge_factors.empty());
  scene_.impurities->map = Ramp().shares;
  EXPECT_EQ(Run().potencies[NodeAt(2, 0, 0)], 1.5);
  scene_.impurities->noise = 0.1;
  EXPECT_NE(Run().potencies[NodeAt(2, 0, 0)], 1.5);
  EXPECT_NEAR(Run().potencies[NodeAt(2, 0, 0)], 1.5, 0.5);
}

TEST_F(Bake, JoinsPotenciesByTheBlendOfEachLayer) {
  scene_.impurities->potency = 1;
  Add(Ramp()).potency = 2;  // the larger of 1 and x / 2
  for (const int x : {0, 1, 2, 3, 4})
    EXPECT_DOUBLE_EQ(Run().potencies[NodeAt(x, 1, 1)], std::max(1.0, x / 2.0));
  Add(Ramp(), Blend::kAdd).potency = 8;
  for (const int x : {0, 1, 2, 3, 4})
    EXPECT_DOUBLE_EQ(Run().potencies[NodeAt(x, 1, 1)], std::max(1.0, x / 2.0) + 2 * x);
  Add(Ramp(), Blend::kReplace).potency = 0.5;
  for (const int x : {0, 1, 2, 3, 4}) {
    const double below = std::max(1.0, x / 2.0) + 2 * x;
    EXPECT_DOUBLE_EQ(Run().potencies[NodeAt(x, 1, 1)], below + x / 4.0 * (0.5 - below));
  }
}

TEST_F(Bake, JoinsFactorsByTheBlendOfEachLayer) {
  const auto factor_of = [&](std::vector<std::pair<Blend, double>> layers) {
    scene_.impurities->layers.clear();
    for (const auto& [blend, weakening] : layers) Add(Knife(), blend).weakening = weakening;
    const BakedImpurities baked = Run();
    double factor = -1;
    for (size_t e = 0; e < incidence_.edges.size(); ++e) {
      const auto [a, b] = incidence_.edges[e];
      const bool crosses = mesh_.rest_positions[static_cast<size_t>(a)][0] == 2 &&
                           mesh_.rest_positions[static_cast<size_t>(b)][0] == 3;
      EXPECT_EQ(baked.touched_edges[e] != 0, crosses);
      if (!crosses) {
        EXPECT_EQ(baked.edge_factors[e], 1);
      } else {
        EXPECT_TRUE(factor < 0 || factor == baked.edge_factors[e]);
        factor = baked.edge_factors[e];
      }
    }
    return factor;
  };
  EXPECT_EQ(factor_of({{Blend::kMax, 0.5}}), 0.5);
  EXPECT_EQ(factor_of({{Blend::kMax, 0.5}, {Blend::kMax, 0.8}}), 0.5);
  EXPECT_EQ(factor_of({{Blend::kMax, 0.5}, {Blend::kMax, 4}}), 4);
  EXPECT_EQ(factor_of({{Blend::kMax, 0.5}, {Blend::kMax, 0}}), 0);
  EXPECT_EQ(factor_of({{Blend::kMax, 0.5}, {Blend::kAdd, 0.5}}), 0.25);
  EXPECT_EQ(factor_of({{Blend::kMax, kInf}, {Blend::kAdd, 0.5}}), kInf);
  EXPECT_EQ(factor_of({{Blend::kMax, kInf}, {Blend::kAdd, 0}}), 0);
  EXPECT_EQ(factor_of({{Blend::kMax, 0}, {Blend::kAdd, kInf}}), kInf);
  EXPECT_EQ(factor_of({{Blend::kMax, 0.1}, {Blend::kReplace, 0.7}}), 0.7);
}

TEST_F(Bake, WeakensEdgesOfFieldsByTheSmallerShareOfTheirEnds) {
  Add(Ramp()).weakening = 0.2;
  const BakedImpurities baked = Run();
  for (size_t e = 0; e < incidence_.edges.size(); ++e) {
    const auto [a, b] = incidence_.edges[e];
    const double share = std::min(mesh_.rest_positions[static_cast<size_t>(a)][0],
                                  mesh_.rest_positions[static_cast<size_t>(b)][0]) /
                         4;
    EXPECT_NEAR(baked.edge_factors[e], 1 - 0.8 * share, 1e-12);
  }
  // Potencies stay where a layer has none.
  EXPECT_TRUE(std::all_of(baked.potencies.begin(), baked.potencies.end(),
                          [](double potency) { return potency == 0; }));
}

TEST_F(Bake, StrokesMakeTheEndsOfCrossedEdgesImpureAndFallOffBeyond) {
  Add(Knife()).potency = 4;
  for (const int x : {0, 1, 2, 3, 4})
    EXPECT_EQ(Run().potencies[NodeAt(x, 2, 1)], x == 2 || x == 3 ? 4 : 0);
  scene_.impurities->layers[0].falloff = 2;
  EXPECT_DOUBLE_EQ(Run().potencies[NodeAt(4, 2, 1)], 1);
  EXPECT_DOUBLE_EQ(Run().potencies[NodeAt(1, 2, 1)], 1);
  EXPECT_EQ(Run().potencies[NodeAt(0, 2, 1)], 0);
  scene_.impurities->layers[0].falloff_shape = FalloffShape::kSmooth;
  EXPECT_DOUBLE_EQ(Run().potencies[NodeAt(4, 2, 1)], 4 * 5.0 / 32);
  // To a depth of 1.2, with a groove 1.6 wide on each side.
  Strokes laser = Knife();
  laser.depth = 1.2;
  laser.radius = 1.6;
  scene_.impurities->layers.clear();
  Add(laser).potency = 4;
  scene_.impurities->layers[0].weakening = 0;
  const BakedImpurities baked = Run();
  EXPECT_EQ(baked.potencies[NodeAt(4, 2, 2)], 4);
  EXPECT_EQ(baked.potencies[NodeAt(1, 2, 3)], 4);
  EXPECT_EQ(baked.potencies[NodeAt(0, 2, 3)], 0);
  EXPECT_EQ(baked.potencies[NodeAt(2, 2, 0)], 0);
  for (size_t e = 0; e < incidence_.edges.size(); ++e) {
    const Vec3& a = mesh_.rest_positions[static_cast<size_t>(incidence_.edges[e][0])];
    const Vec3& b = mesh_.rest_positions[static_cast<size_t>(incidence_.edges[e][1])];
    const bool within = std::min(a[0], b[0]) >= 1 && std::min(a[2], b[2]) >= 2;
    const bool crossed =
        std::min(a[0], b[0]) == 2 && std::max(a[0], b[0]) == 3 && (a[2] + b[2]) / 2 >= 1.8;
    EXPECT_EQ(baked.edge_factors[e] == 0, within || crossed) << e;
  }
}

TEST_F(Bake, PatternsArePlacedByOriginTurnAndScale) {
  // A line of the drawing from (-1, 0) to (1, 0), turned upright, over the middle of the top.
  SegmentPattern pattern;
  pattern.curves = {{{{-1, 0}, {1, 0}}, {}}};
  pattern.origin = {1.5, 1.5, 77};
  pattern.scale = 5;
  pattern.rotation = std::acos(0.0);
  Add(pattern).potency = 1;
  for (const int x : {0, 1, 2, 3, 4})
    EXPECT_EQ(Run().potencies[NodeAt(x, 1, 2)], x == 1 || x == 2 ? 1 : 0) << x;
  // The same by another up; from the side; and drawn with width.
  pattern.rotation = 0;
  pattern.up = {1, 0, 3};
  scene_.impurities->layers[0].source = pattern;
  EXPECT_EQ(Run().potencies[NodeAt(2, 1, 2)], 1);
  EXPECT_EQ(Run().potencies[NodeAt(3, 1, 2)], 0);
  pattern.direction = {-1, 0, 0};
  pattern.up = {0, 0, 1};
  scene_.impurities->layers[0].source = pattern;
  EXPECT_EQ(Run().potencies[NodeAt(4, 1, 1)], 0);  // z = 77 is above it
  pattern.origin[2] = 1.5;
  scene_.impurities->layers[0].source = pattern;
  for (const int z : {0, 1, 2, 3})
    EXPECT_EQ(Run().potencies[NodeAt(4, 1, z)], z == 1 || z == 2 ? 1 : 0) << z;
  pattern.curves[0].half_widths = {0.31, 0.31};
  scene_.impurities->layers[0].source = pattern;
  for (const int z : {0, 1, 2, 3}) EXPECT_EQ(Run().potencies[NodeAt(4, 1, z)], 1) << z;
}

TEST_F(Bake, PaintIsCarriedInwardToItsDepth) {
  SurfacePaint paint;
  for (const Vec3& point : mesh_.rest_positions) paint.shares.push_back(point[0] / 4);
  // Inner nodes do not count.
  paint.shares[NodeAt(1, 1, 1)] = 1;
  paint.depth = 0.9;
  Add(paint).potency = 4;
  EXPECT_DOUBLE_EQ(Run().potencies[NodeAt(3, 0, 0)], 3);
  EXPECT_EQ(Run().potencies[NodeAt(1, 1, 1)], 0);
  std::get<SurfacePaint>(scene_.impurities->layers[0].source).depth = 1.1;
  EXPECT_GE(Run().potencies[NodeAt(1, 1, 1)], 0);
  EXPECT_LE(Run().potencies[NodeAt(1, 1, 1)], 1);
  EXPECT_DOUBLE_EQ(Run().potencies[NodeAt(2, 1, 1)], 2);
  // A painted triangle beside the body.
  paint.vertices = {{-0.5, -9, -9}, {-0.5, 20, -9}, {-0.5, -9, 20}};
  paint.triangles = {{0, 1, 2}};
  paint.shares = {0.5, 0.5, 0.5};
  paint.depth = 1;
  scene_.impurities->layers[0].source = paint;
  scene_.impurities->layers[0].falloff = 2;
  for (const int x : {0, 1, 2, 3}) {
    EXPECT_NEAR(Run().potencies[NodeAt(x, 1, 1)], 2 * std::clamp((2.5 - x) / 2, 0.0, 1.0), 1e-12);
  }
}

TEST_F(Bake, HoldsLayersToTheirNodeSets) {
  scene_.node_sets = {{"left", {PlaneSelector{{2.2, 0, 0}, {-1, 0, 0}}}}};
  ImpurityLayer& layer = Add(NoiseField{}, Blend::kAdd);
  layer.potency = 1;
  layer.node_set = "left";
  const BakedImpurities noisy = Run();
  for (const int x : {0, 1, 2, 3, 4}) EXPECT_EQ(noisy.potencies[NodeAt(x, 1, 2)] != 0, x <= 2);
  scene_.impurities->layers.clear();
  ImpurityLayer& cut = Add(Knife());
  cut.weakening = 0;
  cut.node_set = "left";
  const BakedImpurities baked = Run();
  EXPECT_EQ(std::count(baked.edge_factors.begin(), baked.edge_factors.end(), 0), 0);
}

TEST_F(Bake, DrawsApartForEveryLayerAndTheSameForTheSameSeed) {
  Add(NoiseField{}, Blend::kAdd).potency = 1;
  const auto first = Run().potencies;
  Add(NoiseField{}, Blend::kReplace).potency = 1;
  EXPECT_NE(Run().potencies, first);
  scene_.impurities->layers[0].seed = 9;
  scene_.impurities->layers.pop_back();
  const auto seeded = Run().potencies;
  EXPECT_NE(seeded, first);
  scene_.seed = 1234;
  EXPECT_EQ(Run().potencies, seeded);
}

TEST(BakeImpurities, GivesTheSameBitsForAnyNumberOfThreads) {
  const TetMesh mesh = KuhnBox({14, 14, 14}, {1, 1, 1});
  const Incidence incidence = BuildIncidence(mesh);
  Scene scene;
  scene.impurities.emplace();
  Strokes strokes;
  for (int k = 0; k < 40; ++k) {
    const double turn = 0.61 * k;
    strokes.curves.push_back({{{0.5, 0.5, 0}, {0.5 + std::cos(turn), 0.5 + std::sin(turn), 0}}});
  }
  strokes.depth = 0.43;
  strokes.radius = 0.02;
  for (const ImpuritySource& source :
       {ImpuritySource(strokes), ImpuritySource(NoiseField{NoiseDistribution::kUniform, 0.2}),
        ImpuritySource(PocketField{30, 0.05})}) {
    ImpurityLayer& layer = scene.impurities->layers.emplace_back();
    layer.source = source;
    layer.potency = 1;
    layer.blend = Blend::kAdd;
    if (!std::holds_alternative<NoiseField>(source)) {
      layer.falloff = 0.1;
      layer.weakening = 0.5;
    }
  }
  const auto run = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return BakeImpurities(scene, mesh, incidence.edges); });
  };
  const BakedImpurities one = run(1), three = run(3);
  EXPECT_EQ(one.potencies, three.potencies);
  EXPECT_EQ(one.edge_factors, three.edge_factors);
  EXPECT_EQ(one.touched_edges, three.touched_edges);
}

}  // namespace
}  // namespace cleave
