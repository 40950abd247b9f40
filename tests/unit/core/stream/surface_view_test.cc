#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "gtest/gtest.h"
#include "tbb/task_arena.h"
#include "tests/unit/core/stream/stream_fixture.h"
#include "tests/unit/core/stream/surface_view_scene.h"

namespace cleave {
namespace {

using namespace stream_test;

// By definition, from scratch.
std::vector<uint8_t> VisibleNodes(const Body& body, const std::vector<int32_t>& broken) {
  std::set<std::array<int32_t, 2>> gone;
  for (const int32_t edge : broken) gone.insert(body.edges[static_cast<size_t>(edge)]);
  std::map<std::array<int32_t, 3>, int> faces;
  std::vector<uint8_t> apart(body.rest.size(), 0);
  for (std::array<int32_t, 4> tet : body.tets) {
    std::sort(tet.begin(), tet.end());
    ++faces[{tet[0], tet[1], tet[2]}];
    ++faces[{tet[0], tet[1], tet[3]}];
    ++faces[{tet[0], tet[2], tet[3]}];
    ++faces[{tet[1], tet[2], tet[3]}];
    std::array<bool, 4> reached = {true, false, false, false};
    for (int round = 0; round < 3; ++round) {
      for (size_t from = 0; from < 4; ++from) {
        for (size_t to = 0; to < 4; ++to) {
          const bool joined =
              !gone.contains({std::min(tet[from], tet[to]), std::max(tet[from], tet[to])});
          reached[to] = reached[to] || (reached[from] && joined);
        }
      }
    }
    const bool is_apart = std::count(reached.begin(), reached.end(), true) < 4;
    for (const int32_t node : tet) apart[static_cast<size_t>(node)] |= is_apart ? 1 : 0;
  }
  std::vector<uint8_t> visible = apart;
  for (const auto& [face, count] : faces) {
    for (const int32_t node : face) visible[static_cast<size_t>(node)] |= count == 1 ? 1 : 0;
  }
  for (const auto& [a, b] : body.edges) {
    visible[static_cast<size_t>(a)] |= apart[static_cast<size_t>(b)];
    visible[static_cast<size_t>(b)] |= apart[static_cast<size_t>(a)];
  }
  return visible;
}

std::vector<Vec3> ByPlace(const NodeOrder& order, const std::vector<Vec3>& positions) {
  std::vector<Vec3> by_place;
  for (const int32_t node : order.nodes) by_place.push_back(positions[static_cast<size_t>(node)]);
  return by_place;
}

TEST(SurfaceView, StencilsAreThoseOfVisiblePlacesHoweverTheEdgesCameToBreak) {
  const Body body = LatticeBody(10, 6, 6);
  const NodeOrder order = MakeNodeOrder(body.rest);
  Stencils grown(order, ByPlace(order, body.rest), body.mesh());
  size_t visible_before = 0;
  for (int64_t number = 0; number < 22; ++number) {
    // Back at once in between, as after an epoch's begin.
    const std::vector<int32_t> broken = TumblingFrame(body, number == 15 ? 9 : number).broken_edges;
    grown.SetBroken(order, broken);
    Stencils made(order, ByPlace(order, body.rest), body.mesh());
    made.SetBroken(order, broken);
    const std::vector<uint8_t> visible = VisibleNodes(body, broken);
    size_t count = 0;
    for (int32_t place = 0; place < static_cast<int32_t>(order.nodes.size()); ++place) {
      const auto node = static_cast<size_t>(order.nodes[static_cast<size_t>(place)]);
      ASSERT_EQ(grown.visible()->Has(place), visible[node] != 0) << place << " in " << number;
      if (visible[node] == 0) continue;
      ++count;
      ASSERT_EQ(grown[place].places, made[place].places) << place << " in " << number;
      ASSERT_EQ(grown[place].weights, made[place].weights) << place << " in " << number;
      if (grown[place].leads()) continue;
      for (const int32_t of : grown[place].places) {
        ASSERT_TRUE(grown.visible()->Has(of));
        ASSERT_EQ(grown.pieces()[of], grown.pieces()[place]);
      }
    }
    ASSERT_EQ(grown.leaders(), made.leaders());
    ASSERT_EQ(grown.leaders().size(), static_cast<size_t>(grown.pieces().count()));
    if (number != 15 && number != 16) {
      EXPECT_GE(count, visible_before);
    }
    visible_before = count;
  }
  EXPECT_GT(visible_before, body.rest.size() * 8 / 10);
}

// By definition, from scratch.
std::vector<int32_t> StencilPlaces(const Stencils& stencils, const std::set<int32_t>& broken,
                                   int32_t place) {
  std::vector<int32_t> places;
  for (const NearPlaces::Near& one : stencils.near()->Of(place)) {
    const bool is_joined = !broken.contains(one.edges[0]) && !broken.contains(one.edges[1]);
    const bool is_usable = stencils.visible()->Has(one.place) &&
                           stencils.pieces()[one.place] == stencils.pieces()[place];
    if (is_joined && is_usable && places.size() < kStencilNodes) places.push_back(one.place);
  }
  const int32_t leader = stencils.LeaderOf(stencils.pieces()[place]);
  if (places.empty()) places.push_back(leader == place ? -1 : leader);
  places.resize(kStencilNodes, places[0]);
  return places;
}

TEST(SurfaceView, StencilsAreOfNearPlacesHoweverFewEdgesBreakAtATime) {
  const Body body = LatticeBody(13, 9, 8);
  const NodeOrder order = MakeNodeOrder(body.rest);
  const std::vector<Vec3> rest = ByPlace(order, body.rest);
  Stencils stencils(order, rest, body.mesh());
  std::set<int32_t> broken;
  size_t pieces = 1;
  for (uint64_t round = 0; round < 60; ++round) {
    // Now one or two, now a ball's, so that parts come off and surfaces grow inside.
    if (round % 3 == 2) {
      const Vec3& centre = rest[static_cast<size_t>(std::abs(Random(21, round, 0)) * 900)];
      for (size_t edge = 0; edge < body.edges.size(); ++edge) {
        double squares[2];
        for (const size_t end : {0, 1}) {
          const Vec3& x = body.rest[static_cast<size_t>(body.edges[edge][end])];
          squares[end] = std::pow(x[0] - centre[0], 2) + std::pow(x[1] - centre[1], 2) +
                         std::pow(x[2] - centre[2], 2);
        }
        const bool holds = round % 2 == 0 && Random(22, round, edge) > 0.9;
        if ((squares[0] < 0.03) != (squares[1] < 0.03) && !holds) {
          broken.insert(static_cast<int32_t>(edge));
        }
      }
    } else {
      const double of_all = std::abs(Random(23, round, 0)) * static_cast<double>(body.edges.size());
      broken.insert(static_cast<int32_t>(of_all));
    }
    stencils.SetBroken(order, std::vector<int32_t>(broken.begin(), broken.end()));
    for (const int32_t place : stencils.visible()->places()) {
      const std::array<int32_t, kStencilNodes>& places = stencils[place].places;
      ASSERT_EQ(std::vector<int32_t>(places.begin(), places.end()),
                StencilPlaces(stencils, broken, place))
          << place << " in " << round;
    }
    pieces = static_cast<size_t>(stencils.pieces().count());
  }
  EXPECT_GT(pieces, 10u);
}

class SurfaceViewTest : public ::testing::TestWithParam<uint16_t> {};

TEST_P(SurfaceViewTest, VisibleNodesKeepTheToleranceInEveryFrameAndSeekingEqualsGoingOn) {
  const Body body = LatticeBody(10, 6, 6);
  FrameEncoder encoder = MakeEncoder(OfSurface(body, GetParam()), body.mesh());
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
  FrameDecoder late = MakeDecoder(encoder.header_bytes(), body.mesh());
  size_t first_visible = 0;
  size_t visible = 0;
  for (int64_t number = 0; number < 24; ++number) {
    Frame frame = TumblingFrame(body, number == 13 ? 12 : number);  // 13 holds
    frame.frame = number;
    if (number == 20) {
      ASSERT_TRUE(encoder.StartEpoch(1).ok());
    }
    if (number >= 20) frame.broken_edges = TumblingFrame(body, number - 10).broken_edges;
    // An encoder that goes on from what a viewer has makes the same bytes.
    auto resumed = FrameEncoder::Create(decoder.header(), body.mesh(), decoder.state());
    ASSERT_TRUE(resumed.ok()) << resumed.status();
    if (number >= 20 && decoder.epoch() == 0) {
      ASSERT_TRUE(resumed->StartEpoch(1).ok());
    }
    const auto encoded = encoder.Encode(frame);
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    const auto again = resumed->Encode(frame);
    ASSERT_TRUE(again.ok()) << again.status();
    ASSERT_EQ(again->bytes, encoded->bytes) << number;
    if (number == 13) {
      EXPECT_EQ(encoded->header.kind, FrameKind::kHold);
    }
    ASSERT_TRUE(decoder.Apply(encoded->bytes).ok()) << number;
    if (number >= 8) {
      ASSERT_TRUE(late.Apply(encoded->bytes).ok()) << number;
      ASSERT_EQ(late.frame().positions, decoder.frame().positions);
    }
    ASSERT_EQ(encoder.state().positions, decoder.state().positions);
    ASSERT_EQ(encoder.state().previous, decoder.state().previous);
    const Frame& decoded = decoder.frame();
    ASSERT_EQ(decoded.visible, VisibleNodes(body, frame.broken_edges));
    visible = 0;
    for (size_t node = 0; node < body.rest.size(); ++node) {
      if (decoded.visible[node] == 0) continue;
      ++visible;
      for (size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(decoded.positions[node][axis], frame.positions[node][axis], kTolerance);
        ASSERT_NEAR(static_cast<float>(decoded.positions[node][axis]), frame.positions[node][axis],
                    kTolerance);
      }
    }
    if (number == 0) first_visible = visible;
  }
  EXPECT_EQ(first_visible, 360u - 8 * 4 * 4);
  EXPECT_GT(visible, first_visible + 60);
}

TEST_P(SurfaceViewTest, AFrameThatIsRefusedChangesNothing) {
  const Body body = LatticeBody(10, 6, 6);
  FrameEncoder encoder = MakeEncoder(OfSurface(body, GetParam()), body.mesh());
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
  for (int64_t number = 0; number < 14; ++number) {
    const std::string good = encoder.Encode(TumblingFrame(body, number))->bytes;
    // The state hash fails when all else was decoded, with what came into view.
    FrameHeader header = SplitFrame(good)->header;
    header.state_hash ^= 1;
    std::string forged;
    AppendFrameHeader(header, forged);
    forged += good.substr(kFrameHeaderBytes);
    const StreamState before = decoder.state();
    ASSERT_EQ(decoder.Apply(forged).code(), absl::StatusCode::kDataLoss) << number;
    // And one that has no positions.
    FrameHeader bare = SplitFrame(good)->header;
    bare.section_count = 0;
    bare.frame_bytes = kFrameHeaderBytes;
    bare.broken_edges = before.broken_edges.size();
    std::string empty;
    AppendFrameHeader(bare, empty);
    ASSERT_FALSE(decoder.Apply(empty).ok());
    ASSERT_EQ(decoder.state().positions, before.positions);
    ASSERT_EQ(decoder.state().previous, before.previous);
    ASSERT_TRUE(decoder.Apply(good).ok()) << number;
  }
}

INSTANTIATE_TEST_SUITE_P(Coders, SurfaceViewTest,
                         ::testing::Values(kCoderZstdPlanes, kCoderContextRans),
                         [](const ::testing::TestParamInfo<uint16_t>& coder) {
                           return "Coder" + std::to_string(coder.param);
                         });

TEST(SurfaceView, BytesAreTheSameForAnyNumberOfThreads) {
  const Body body = LatticeBody(40, 16, 16);
  std::vector<std::string> expected;
  for (const int threads : {1, 2, 8}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      FrameEncoder encoder = MakeEncoder(OfSurface(body), body.mesh());
      FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
      std::vector<std::string> frames;
      for (const int64_t number : {0, 9, 10, 25, 41}) {
        frames.push_back(encoder.Encode(TumblingFrame(body, number))->bytes);
        ASSERT_TRUE(decoder.Apply(frames.back()).ok());
      }
      if (expected.empty()) expected = frames;
      EXPECT_EQ(frames, expected) << threads;
    });
  }
}

TEST(SurfaceView, WhatCannotBeIsRefused) {
  const Body body = LatticeBody(4, 4, 4);
  StreamParameters parameters = OfSurface(body);
  const auto header = MakeStreamHeader(parameters, body.rest);
  ASSERT_TRUE(header.ok()) << header.status();
  EXPECT_FALSE(FrameEncoder::Create(*header, {body.rest, body.edges}).ok());
  Body other = body;
  std::swap(other.tets[0][3], other.tets[20][3]);
  EXPECT_EQ(FrameEncoder::Create(*header, other.mesh()).status().code(),
            absl::StatusCode::kFailedPrecondition);
  other.tets[0][3] = 64;
  EXPECT_FALSE(FrameEncoder::Create(*header, other.mesh()).ok());
  parameters.predictor_id = kPredictorTemporal;
  parameters.coder_id = kCoderZstdPlanes;
  EXPECT_FALSE(MakeStreamHeader(parameters, body.rest).ok());
  // What a surface view gives is not every node, and no other stream takes it for that.
  FrameEncoder encoder = MakeEncoder(OfSurface(body), body.mesh());
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
  ASSERT_TRUE(decoder.Apply(encoder.Encode(TumblingFrame(body, 0))->bytes).ok());
  parameters.view_id = kViewState;
  FrameEncoder of_state = MakeEncoder(parameters, body.mesh());
  EXPECT_EQ(of_state.Encode(decoder.frame()).status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace cleave
