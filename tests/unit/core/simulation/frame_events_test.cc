#include "core/simulation/frame_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <set>

#include "core/simulation/simulation.h"
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
