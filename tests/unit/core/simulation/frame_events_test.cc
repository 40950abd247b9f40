#include "core/simulation/frame_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <set>

#include "core/simulation/simulation.h"
#include "tests/unit/core/simulation/ductile_bar.h"
#include "tests/unit/core/simulation/fracture_run.h"

namespace cleave {
namespace {

std::unique_ptr<Simulation> Bar(int threads = 1) {
  Simulation::Options options;
  options.threads = threads;
  return *Simulation::Create(BreakingScene(), BreakingMesh(), options);
}

FrameReport Advanced(Simulation& simulation) {
  const StopFlag stop;
  return *simulation.Advance(stop);
}

constexpr int kFrames = 16;

void ExpectSame(const FrameEvents& a, const FrameEvents& b) {
  ASSERT_EQ(a.edge_breaks.size(), b.edge_breaks.size());
  for (size_t i = 0; i < a.edge_breaks.size(); ++i) {
    EXPECT_EQ(a.edge_breaks[i].edge, b.edge_breaks[i].edge);
    EXPECT_EQ(a.edge_breaks[i].pieces, b.edge_breaks[i].pieces);
    EXPECT_EQ(a.edge_breaks[i].place.position, b.edge_breaks[i].place.position);
    EXPECT_EQ(a.edge_breaks[i].place.energy, b.edge_breaks[i].place.energy);
  }
  ASSERT_EQ(a.splits.size(), b.splits.size());
  for (size_t i = 0; i < a.splits.size(); ++i) {
    EXPECT_EQ(a.splits[i].kept.piece, b.splits[i].kept.piece);
    EXPECT_EQ(a.splits[i].separated.size(), b.splits[i].separated.size());
    EXPECT_EQ(a.splits[i].place.position, b.splits[i].place.position);
  }
}

TEST(FrameEvents, TellOfEveryEdgeOnceWithItsShareOfTheEnergy) {
  const TetMesh mesh = BreakingMesh();
  const Incidence incidence = BuildIncidence(mesh);
  auto simulation = Bar();
  // A viewer who has nothing but the frames.
  NamedPieces pieces(mesh, incidence);
  std::set<int32_t> broken;
  double fracture_energy = 0;
  size_t splits = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const FrameReport report = Advanced(*simulation);
    double energy = 0;
    std::vector<int32_t> edges;
    for (const EdgeBreakEvent& event : report.events.edge_breaks) {
      ASSERT_TRUE(broken.insert(event.edge).second);
      edges.push_back(event.edge);
      const auto& nodes = incidence.edges[static_cast<size_t>(event.edge)];
      EXPECT_EQ(event.nodes, nodes);
      EXPECT_GT(event.place.time, report.time - 0.02);
      EXPECT_LE(event.place.time, report.time);
      for (size_t axis = 0; axis < 3; ++axis) {
        const double rest = 0.5 * (mesh.rest_positions[static_cast<size_t>(nodes[0])][axis] +
                                   mesh.rest_positions[static_cast<size_t>(nodes[1])][axis]);
        EXPECT_DOUBLE_EQ(event.place.rest[axis], rest);
        EXPECT_NEAR(event.place.position[axis], rest, 1);
      }
      energy += event.place.energy;
    }
    EXPECT_EQ(edges.size(), static_cast<size_t>(report.new_broken_edges));
    const double taken = report.fracture_energy - fracture_energy;
    EXPECT_NEAR(energy, taken, 1e-9 * std::max(1.0, taken)) << "frame " << frame;
    fracture_energy = report.fracture_energy;

    const auto own = pieces.Break(edges);
    ASSERT_EQ(own.size(), report.events.splits.size());
    for (size_t i = 0; i < own.size(); ++i) {
      const SplitEvent& split = report.events.splits[i];
      EXPECT_EQ(split.kept.piece, own[i].piece);
      EXPECT_EQ(split.kept.first_node, own[i].parts[0].first_node);
      ASSERT_EQ(split.separated.size() + 1, own[i].parts.size());
      double volume = split.kept.volume;
      for (size_t k = 0; k < split.separated.size(); ++k) {
        const SeparationEvent& separation = split.separated[k];
        EXPECT_EQ(separation.part.piece, own[i].parts[k + 1].piece);
        EXPECT_EQ(separation.part.first_node, own[i].parts[k + 1].first_node);
        EXPECT_LE(separation.part.volume, split.kept.volume);
        EXPECT_GT(separation.place.time, 0);
        EXPECT_LE(separation.place.time, split.place.time);
        volume += separation.part.volume;
      }
      EXPECT_LE(volume, 4.5 + 1e-9);
      ++splits;
    }
    for (const EdgeBreakEvent& event : report.events.edge_breaks) {
      for (size_t k = 0; k < 2; ++k) EXPECT_EQ(event.pieces[k], pieces.piece_of(event.nodes[k]));
    }
  }
  EXPECT_EQ(std::vector<int32_t>(broken.begin(), broken.end()), simulation->broken_edges());
  EXPECT_GT(splits, 0u);
}

// What edges took is what the budget says that breaking took, whichever way tets are weakened; and
// no break adds energy.
void ExpectEnergiesAddUp(const Scene& scene, const TetMesh& mesh, int frames) {
  auto simulation = *Simulation::Create(scene, mesh, {});
  double taken = 0, largest = 0;
  size_t frames_with_breaks = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const FrameReport report = Advanced(*simulation);
    const double lost = report.fracture_energy - taken;
    largest = std::max({largest, report.elastic_energy, lost});
    double energy = 0;
    for (const EdgeBreakEvent& event : report.events.edge_breaks) {
      EXPECT_GE(event.place.energy, -1e-12 * largest) << scene.name << ", edge " << event.edge;
      energy += event.place.energy;
    }
    EXPECT_NEAR(energy, lost, 1e-9 * largest) << scene.name << ", frame " << frame;
    taken = report.fracture_energy;
    frames_with_breaks += report.events.edge_breaks.empty() ? 0 : 1;
  }
  EXPECT_GT(frames_with_breaks, 2u) << scene.name;
  EXPECT_GT(taken, 1e-3 * largest) << scene.name;
}

TEST(FrameEvents, EnergiesOfEdgesAddUpToThatOfFractureInFibres) {
  Scene scene = BreakingScene();
  scene.name = "fibres";
  scene.materials[0].fibres.push_back({1e6, ConstantDirection{{0.8, 0.6, 0}}, 2});
  scene.materials[0].fibres.push_back({3e5, ConstantDirection{{0, 0, 1}}});
  ExpectEnergiesAddUp(scene, BreakingMesh(), kFrames);
}

TEST(FrameEvents, EnergiesOfEdgesAddUpToThatOfFractureInStrandsThatFormAndTear) {
  for (const auto reformulation : {Reformulation::kUniform, Reformulation::kEdgeProjected}) {
    Scene scene = BreakingScene();
    scene.name = "strands";
    scene.fracture.reformulation = reformulation;
    scene.materials[0].strands = Strands{0.2, 1.6};
    ExpectEnergiesAddUp(scene, BreakingMesh(), 24);
  }
}

TEST(FrameEvents, EnergiesOfEdgesAddUpToThatOfFractureInDuctileBodies) {
  Scene scene = TwistedBar();
  scene.name = "ductile";
  scene.materials[0].tensile_strength = 1e6;
  scene.materials[0].plasticity->failure_strain = 0.25;
  ExpectEnergiesAddUp(scene, TwistedBarMesh(), kFrames);
  // Fibres that flow with it.
  scene.name = "ductile with fibres";
  scene.materials[0].fibres.push_back({3e5, ConstantDirection{{1, 0, 0}}});
  ExpectEnergiesAddUp(scene, TwistedBarMesh(), kFrames);
}

TEST(FrameEvents, AreTheSameFromARestoredStateAndOnTwoThreads) {
  auto whole = Bar();
  auto two = Bar(2);
  std::vector<FrameEvents> events;
  std::string saved;
  for (int frame = 0; frame < kFrames; ++frame) {
    events.push_back(Advanced(*whole).events);
    ExpectSame(Advanced(*two).events, events.back());
    if (frame == kFrames / 2) saved = whole->Save();
  }
  auto restored = Bar();
  ASSERT_TRUE(restored->Restore(saved).ok());
  for (size_t frame = kFrames / 2 + 1; frame < kFrames; ++frame)
    ExpectSame(Advanced(*restored).events, events[frame]);
}

}  // namespace
}  // namespace cleave
