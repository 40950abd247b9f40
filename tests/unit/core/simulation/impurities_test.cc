#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/simulation/simulation.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kFar = 1e6;

// A slab pulled apart along x; the nodes with x within 0.3 of 2 are the set "band".
TetMesh Slab() { return KuhnBox({12, 4, 2}, {3, 1, 0.5}); }
Scene PulledSlab() {
  Scene scene = TightScene(1e5, 0.3, 10, 0.004);
  scene.quality.residual_tolerance = 1e-6;
  scene.quality.step_tolerance = 1e-4;
  scene.quality.linear_tolerance = 1e-4;
  scene.materials[0].tensile_strength = 3000;
  AddBoxSet(scene, "x0", {-kFar, -kFar, -kFar}, {1e-9, kFar, kFar});
  AddBoxSet(scene, "x1", {3 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  AddBoxSet(scene, "band", {1.7, -kFar, -kFar}, {2.3, kFar, kFar});
  AddMotion(scene, "x0");
  AddMotion(scene, "x1").keyframes = {{0, {0, 0, 0}, 0}, {1, {0.4, 0, 0}, 0}};
  return scene;
}

// Runs until the slab is in two pieces, or for 120 frames; the first break and the last edges.
struct Outcome {
  int64_t first_break = -1;
  std::vector<int32_t> edges;
};
Outcome Break(const Scene& scene) {
  auto simulation = *Simulation::Create(scene, Slab(), {});
  const StopFlag stop;
  Outcome outcome;
  for (int64_t frame = 1; frame <= 120; ++frame) {
    const auto report = simulation->Advance(stop);
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok()) break;
    if (outcome.first_break < 0 && report->broken_edges > 0) outcome.first_break = frame;
    if (report->fragments > 1) break;
  }
  outcome.edges = simulation->broken_edges();
  return outcome;
}

double ShareInBand(const std::vector<int32_t>& edges) {
  const TetMesh mesh = Slab();
  const Incidence incidence = BuildIncidence(mesh);
  int inside = 0;
  for (const int32_t edge : edges) {
    const auto [a, b] = incidence.edges[static_cast<size_t>(edge)];
    const double middle = 0.5 * (mesh.rest_positions[static_cast<size_t>(a)][0] +
                                 mesh.rest_positions[static_cast<size_t>(b)][0]);
    inside += std::abs(middle - 2) < 0.45 ? 1 : 0;
  }
  return edges.empty() ? 0 : inside / static_cast<double>(edges.size());
}

TEST(Impurities, MoreOfThemBreakTheBodySoonerAndWhereTheyAre) {
  int64_t last = 1000;
  for (const double potency : {0.0, 0.1, 1.0, 10.0}) {
    Scene scene = PulledSlab();
    scene.impurities = Impurities{.potency = potency, .patches = {{"band", 1}}};
    const Outcome outcome = Break(scene);
    ASSERT_GT(outcome.first_break, 0) << potency;
    EXPECT_LE(outcome.first_break, last) << potency;
    // The band is 0.3 of the slab; pure, it breaks at its ends, where it is held.
    if (potency == 0) {
      EXPECT_LT(ShareInBand(outcome.edges), 0.1);
    }
    if (potency >= 1) {
      EXPECT_LT(outcome.first_break, last);
      EXPECT_GT(ShareInBand(outcome.edges), 0.9);
    }
    last = outcome.first_break;
  }
}

TEST(Impurities, MotionBeforeTheFirstBreakDoesNotKnowOfThem) {
  Scene pure = PulledSlab();
  Scene impure = pure;
  impure.impurities = Impurities{.potency = 3, .patches = {{"band", 1}}, .noise = 0.5};
  auto a = *Simulation::Create(pure, Slab(), {});
  auto b = *Simulation::Create(impure, Slab(), {});
  const StopFlag stop;
  int same = 0;
  for (;;) {
    const auto first = a->Advance(stop), second = b->Advance(stop);
    ASSERT_TRUE(first.ok() && second.ok());
    if (second->broken_edges > 0) break;
    ASSERT_EQ(a->positions(), b->positions());
    ++same;
  }
  EXPECT_GT(same, 3);
}

TEST(Impurities, UpgradationStrengthens) {
  Scene scene = PulledSlab();
  const int64_t pure = Break(scene).first_break;
  scene.impurities = Impurities{.effect = ImpurityEffect::kUpgradation, .potency = 0.1};
  EXPECT_GT(Break(scene).first_break, pure);
}

TEST(Impurities, ARestoredRunBreaksTheSameEdges) {
  Scene scene = PulledSlab();
  scene.impurities = Impurities{.potency = 1, .patches = {{"band", 1}}, .noise = 0.3};
  for (const ImpurityMode mode : {ImpurityMode::kExpected, ImpurityMode::kSampled}) {
    scene.impurities->mode = mode;
    auto whole = *Simulation::Create(scene, Slab(), {});
    auto resumed = *Simulation::Create(scene, Slab(), {});
    const StopFlag stop;
    bool broken = false;
    for (int frame = 0; frame < 120 && !broken; ++frame) {
      const auto report = whole->Advance(stop);
      ASSERT_TRUE(report.ok());
      broken = report->broken_edges > 0;
    }
    ASSERT_TRUE(broken);
    ASSERT_TRUE(resumed->Restore(whole->Save()).ok());
    for (int frame = 0; frame < 5; ++frame) {
      ASSERT_TRUE(whole->Advance(stop).ok());
      ASSERT_TRUE(resumed->Advance(stop).ok());
      ASSERT_EQ(whole->state_hash(), resumed->state_hash());
    }
  }
}

TEST(Impurities, TheBaselinesDiffer) {
  Scene scene = PulledSlab();
  const Outcome without = Break(scene);
  scene.impurities = Impurities{.model = ImpurityModel::kOff, .potency = 1, .noise = 0.5};
  EXPECT_EQ(Break(scene).edges, without.edges);
  std::vector<Outcome> outcomes;
  for (const ImpurityModel model :
       {ImpurityModel::kGraph, ImpurityModel::kStatic, ImpurityModel::kUncorrelated}) {
    scene.impurities->model = model;
    outcomes.push_back(Break(scene));
    EXPECT_NE(outcomes.back().edges, without.edges);
  }
  EXPECT_NE(outcomes[0].edges, outcomes[1].edges);
  EXPECT_NE(outcomes[1].edges, outcomes[2].edges);
}

TEST(Impurities, ASeedGivesItsOwnCracks) {
  Scene scene = PulledSlab();
  scene.impurities = Impurities{.potency = 0.3, .noise = 0.5};
  const Outcome first = Break(scene);
  EXPECT_EQ(Break(scene).edges, first.edges);
  scene.seed = 1;
  EXPECT_NE(Break(scene).edges, first.edges);
}

double Jaccard(const std::vector<int32_t>& a, const std::vector<int32_t>& b) {
  std::vector<int32_t> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return static_cast<double>(common.size()) /
         static_cast<double>(a.size() + b.size() - common.size());
}

// Cracks of Gaussian and of uniform noise are no farther apart than those of two seeds.
TEST(Impurities, TheDistributionOfNoiseMattersNoMoreThanTheSeed) {
  constexpr int kSeeds = 3;
  std::vector<std::vector<int32_t>> cracks[2];
  for (const size_t kind : {0u, 1u}) {
    Scene scene = PulledSlab();
    scene.impurities = Impurities{.potency = 0.5, .patches = {{"band", 1}}, .noise = 0.3};
    scene.impurities->distribution =
        kind == 0 ? NoiseDistribution::kGaussian : NoiseDistribution::kUniform;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
      scene.seed = seed;
      cracks[kind].push_back(Break(scene).edges);
    }
  }
  double between = 0, within = 0, least = 1, most = 0;
  int pairs = 0;
  for (size_t a = 0; a < kSeeds; ++a) {
    for (size_t b = 0; b < kSeeds; ++b) between += Jaccard(cracks[0][a], cracks[1][b]);
    for (size_t b = 0; b < a; ++b) {
      for (const auto& kind : cracks) {
        const double overlap = Jaccard(kind[a], kind[b]);
        within += overlap;
        least = std::min(least, overlap);
        most = std::max(most, overlap);
        ++pairs;
      }
    }
  }
  between /= kSeeds * kSeeds;
  within /= pairs;
  EXPECT_GT(between, least);
  EXPECT_NEAR(between, within, most - least) << "between " << between << ", within " << within;
  EXPECT_LT(most, 1);  // seeds differ at all
}

// A stroke across the slab at x = 1.6, between two cross-sections of nodes.
ImpurityLayer Stroke() {
  Strokes strokes;
  strokes.curves = {{{{1.6, -9, 0}, {1.6, 9, 0}}}};
  ImpurityLayer layer;
  layer.source = strokes;
  return layer;
}

TEST(ImpurityLayers, AStrokeThatWeakensToNothingCutsTheBodyBeforeTheFirstStep) {
  for (const bool breakable : {true, false}) {
    for (const ImpurityModel model : {ImpurityModel::kGraph, ImpurityModel::kOff}) {
      Scene scene = PulledSlab();
      if (!breakable) scene.materials[0].tensile_strength.reset();
      scene.impurities = Impurities{.model = model};
      scene.impurities->layers = {Stroke()};
      scene.impurities->layers[0].weakening = 0;
      EXPECT_EQ((*Simulation::Create(scene, Slab(), {}))->fragments(), 2);
      scene.impurities->layers[0].weakening = 0.5;
      EXPECT_EQ((*Simulation::Create(scene, Slab(), {}))->fragments(), 1);
    }
  }
}

TEST(ImpurityLayers, AStrokeGuidesTheCrackByPotencyAndByWeakening) {
  Scene scene = PulledSlab();
  const auto near_stroke = [](const std::vector<int32_t>& edges) {
    const Incidence incidence = BuildIncidence(Slab());
    const TetMesh mesh = Slab();
    return std::count_if(edges.begin(), edges.end(), [&](int32_t edge) {
      const auto [a, b] = incidence.edges[static_cast<size_t>(edge)];
      return std::min(mesh.rest_positions[static_cast<size_t>(a)][0],
                      mesh.rest_positions[static_cast<size_t>(b)][0]) == 1.5 &&
             std::max(mesh.rest_positions[static_cast<size_t>(a)][0],
                      mesh.rest_positions[static_cast<size_t>(b)][0]) == 1.75;
    });
  };
  scene.impurities = Impurities{};
  scene.impurities->layers = {Stroke()};
  scene.impurities->layers[0].weakening = 0.3;
  const Outcome weakened = Break(scene);
  ASSERT_GT(weakened.edges.size(), 5u);
  EXPECT_EQ(near_stroke(weakened.edges), static_cast<int64_t>(weakened.edges.size()));
  scene.impurities->layers[0].weakening.reset();
  scene.impurities->layers[0].potency = 10;
  const Outcome impure = Break(scene);
  ASSERT_GT(impure.edges.size(), 5u);
  EXPECT_GE(near_stroke(impure.edges), static_cast<int64_t>(impure.edges.size()) / 2);
}

TEST(ImpurityLayers, BelongToTheSceneOfASavedState) {
  Scene scene = PulledSlab();
  scene.impurities = Impurities{};
  scene.impurities->layers = {Stroke()};
  scene.impurities->layers[0].potency = 1;
  const auto simulation = *Simulation::Create(scene, Slab(), {});
  std::get<Strokes>(scene.impurities->layers[0].source).curves[0].points[0][0] = 1.61;
  const auto other = *Simulation::Create(scene, Slab(), {});
  EXPECT_FALSE(other->Restore(simulation->Save()).ok());
}

}  // namespace
}  // namespace cleave
