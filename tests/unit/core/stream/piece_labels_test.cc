#include "core/stream/piece_labels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

PieceLabels LabelsOf(const Body& body) {
  const NodeOrder order = MakeNodeOrder(body.rest);
  std::vector<Vec3> by_place;
  for (const int32_t node : order.nodes) by_place.push_back(body.rest[static_cast<size_t>(node)]);
  return PieceLabels(order, Stencils(order, by_place, body.edges), body.edges);
}

// The pieces that are left when these edges break.
std::vector<int32_t> PiecesOf(const Body& body, std::span<const int32_t> broken) {
  const NodeOrder order = MakeNodeOrder(body.rest);
  EdgeGraph graph(order, body.edges);
  for (const int32_t edge : broken) graph.Break(edge);
  Pieces pieces;
  pieces.Find(order, graph);
  return pieces.labels();
}

// The edges between cells of random centres.
std::vector<int32_t> EdgesBetweenCells(const Body& body, uint64_t cells) {
  const auto cell_of = [&](size_t node) {
    uint64_t nearest = 0;
    double least = 1e9;
    for (uint64_t cell = 0; cell < cells; ++cell) {
      double square = 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        const double d = body.rest[node][axis] - 1.5 * (1 + Random(8, cell, axis));
        square += d * d;
      }
      if (square < least) {
        least = square;
        nearest = cell;
      }
    }
    return nearest;
  };
  std::vector<uint64_t> cells_of(body.rest.size());
  for (size_t node = 0; node < cells_of.size(); ++node) cells_of[node] = cell_of(node);
  std::vector<int32_t> edges;
  for (size_t edge = 0; edge < body.edges.size(); ++edge) {
    const auto& [a, b] = body.edges[edge];
    if (cells_of[static_cast<size_t>(a)] != cells_of[static_cast<size_t>(b)]) {
      edges.push_back(static_cast<int32_t>(edge));
    }
  }
  return edges;
}

TEST(PieceLabels, SayWhichEdgesJoinDifferentPieces) {
  const Body body = LatticeBody(30, 20, 20);
  const PieceLabels labels = LabelsOf(body);
  const std::vector<int32_t> broken = EdgesBetweenCells(body, 20);
  ASSERT_GT(broken.size(), 5000u);
  const std::string coded = labels.Encode(PiecesOf(body, broken));
  const auto said = labels.Decode(coded);
  ASSERT_TRUE(said.ok()) << said.status();
  EXPECT_EQ(*said, broken);
  EXPECT_LE(static_cast<double>(coded.size()), 0.12 * static_cast<double>(broken.size()));
}

TEST(PieceLabels, LeaveOutOnlyEdgesThatBrokeInsideAPiece) {
  const Body body = LatticeBody(8, 6, 5);
  const PieceLabels labels = LabelsOf(body);
  for (const double share : {0.0, 0.3, 0.8, 0.95, 1.0}) {
    std::vector<int32_t> broken;
    for (uint64_t edge = 0; edge < body.edges.size(); ++edge) {
      if (Random(2, edge, 0) < 2 * share - 1) broken.push_back(static_cast<int32_t>(edge));
    }
    const auto said = labels.Decode(labels.Encode(PiecesOf(body, broken)));
    ASSERT_TRUE(said.ok()) << said.status();
    EXPECT_EQ(*said, labels.Between(PiecesOf(body, broken)));
    EXPECT_TRUE(std::includes(broken.begin(), broken.end(), said->begin(), said->end()));
    if (share == 1) {
      EXPECT_EQ(*said, broken);
    }
  }
}

TEST(PieceLabels, DamagedOnesAreRefusedOrSayOtherEdges) {
  const Body body = LatticeBody(8, 6, 5);
  const PieceLabels labels = LabelsOf(body);
  const std::string coded = labels.Encode(PiecesOf(body, EdgesBetweenCells(body, 6)));
  for (size_t size = 0; size < coded.size(); ++size) {
    EXPECT_FALSE(labels.Decode(coded.substr(0, size)).ok()) << size;
  }
  EXPECT_FALSE(labels.Decode(coded + '\0').ok());
  for (size_t at = 0; at < coded.size(); ++at) {
    for (const char change : {'\x01', '\x3f', '\x40', '\x80', '\xff'}) {
      std::string damaged = coded;
      damaged[at] ^= change;
      const auto said = labels.Decode(damaged);
      if (!said.ok()) continue;
      EXPECT_TRUE(std::is_sorted(said->begin(), said->end()));
      EXPECT_TRUE(said->empty() || static_cast<size_t>(said->back()) < body.edges.size());
    }
  }
}

// Rests on stencils, holds and contexts alike, so it stands here as the sum of them.
TEST(InterpolatedStream, ATumblingBodyCostsAtMostAFewHundredthsOfAByteANode) {
  const Body body = LatticeBody(48, 20, 20);
  StreamParameters parameters = Parameters(body.edges.size(), 0, 1000);
  parameters.chunk_nodes = 16384;
  parameters.predictor_id = kPredictorInterpolation;
  parameters.coder_id = kCoderContextRans;
  FrameEncoder encoder = MakeEncoder(parameters, body.mesh());
  size_t bytes = 0;
  for (int64_t number = 0; number < 12; ++number) {
    Frame frame;
    frame.frame = number;
    const double angle = 0.15 * static_cast<double>(number);
    for (const Vec3& x : body.rest) {
      frame.positions.push_back({std::cos(angle) * x[0] - std::sin(angle) * x[1] + 0.3 * angle,
                                 std::sin(angle) * x[0] + std::cos(angle) * x[1],
                                 x[2] - angle * angle});
    }
    const auto encoded = encoder.Encode(frame);
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    if (number >= 4) bytes += encoded->bytes.size();
  }
  EXPECT_LE(static_cast<double>(bytes) / 8, 0.05 * static_cast<double>(body.rest.size()));
}

}  // namespace
}  // namespace cleave
