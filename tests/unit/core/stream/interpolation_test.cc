#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "core/stream/node_order.h"
#include "core/stream/stencils.h"
#include "gtest/gtest.h"
#include "tbb/task_arena.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

constexpr int64_t kShatterFrame = 30;

// A body that bends; from frame 5 on edges break in walls across it, in frame 30 all that are left.
// Its parts drift away from each other.
Frame BreakingFrame(const Body& body, int64_t number) {
  Frame frame;
  frame.frame = number;
  frame.time = static_cast<double>(number) / 24;
  frame.positions = body.rest;
  const double t = frame.time;
  const auto part_of = [&](size_t node) {
    return std::floor(2.5 * body.rest[node][0]) + 10 * std::floor(2.5 * body.rest[node][1]);
  };
  for (size_t node = 0; node < body.rest.size(); ++node) {
    Vec3& x = frame.positions[node];
    const double part = part_of(node);
    const double apart = std::max(0.0, t - 0.4);
    const double bend = 0.1 * std::sin(5 * t) * x[0] * x[0];
    x[0] += apart * std::sin(part) + 0.2 * apart * apart * x[1];
    x[1] += apart * std::cos(part) - 0.2 * apart * apart * x[0];
    x[2] += bend - 2 * apart * apart;
  }
  for (size_t edge = 0; edge < body.edges.size(); ++edge) {
    const auto a = static_cast<size_t>(body.edges[edge][0]);
    const auto b = static_cast<size_t>(body.edges[edge][1]);
    const bool cracks =
        part_of(a) != part_of(b) && body.rest[a][2] < 0.2 * static_cast<double>(number - 4);
    const bool alone = number >= 8 && a == body.rest.size() / 2;  // a piece of one node, nearly
    if (cracks || alone || number >= kShatterFrame) {
      frame.broken_edges.push_back(static_cast<int32_t>(edge));
    }
  }
  return frame;
}

class Interpolation : public ::testing::TestWithParam<uint16_t> {
 protected:
  StreamParameters With(const Body& body, double tolerance, uint32_t keyframe_interval) const {
    StreamParameters parameters = Parameters(body.edges.size(), tolerance, keyframe_interval);
    parameters.predictor_id = kPredictorInterpolation;
    parameters.coder_id = GetParam();
    return parameters;
  }

  // Encodes and decodes the frame, holds the pair to the promise of the format, gives the size.
  static size_t ExpectRoundTrip(FrameEncoder& encoder, FrameDecoder& decoder, const Frame& frame,
                                double tolerance) {
    const absl::StatusOr<EncodedFrame> encoded = encoder.Encode(frame);
    EXPECT_TRUE(encoded.ok()) << encoded.status();
    if (!encoded.ok()) return 0;
    const absl::Status applied = decoder.Apply(encoded->bytes);
    EXPECT_TRUE(applied.ok()) << applied;
    EXPECT_EQ(decoder.frame().broken_edges, frame.broken_edges);
    EXPECT_LE(WorstErrors(frame, decoder.frame()).as_float, tolerance) << frame.frame;
    EXPECT_EQ(decoder.state().positions, encoder.state().positions);
    EXPECT_EQ(decoder.state().previous, encoder.state().previous);
    return encoded->bytes.size();
  }
};

TEST_P(Interpolation, EveryNodeOfEveryFrameStaysWithinTheTolerance) {
  const Body body = LatticeBody(12, 6, 5);
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    FrameEncoder encoder = MakeEncoder(With(body, tolerance, 12), body.mesh());
    FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
    for (int64_t frame = 0; frame < 40; ++frame) {
      ExpectRoundTrip(encoder, decoder, BreakingFrame(body, frame), tolerance);
    }
  }
}

TEST_P(Interpolation, ErrorDoesNotGrowOverTenThousandFramesOfTeleportsAndBreaks) {
  const Body body = LatticeBody(4, 3, 2);
  FrameEncoder encoder = MakeEncoder(With(body, 1e-4, 1000000), body.mesh());
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
  Frame frame;
  frame.positions = body.rest;
  for (frame.frame = 0; frame.frame < 10000; ++frame.frame) {
    const auto step = static_cast<uint64_t>(frame.frame);
    const double speed = frame.frame % 97 == 0 ? 10 : 1e-3;  // at times everything jumps
    for (size_t node = 0; node < body.rest.size(); ++node) {
      for (size_t axis = 0; axis < 3; ++axis) {
        frame.positions[node][axis] =
            std::clamp(frame.positions[node][axis] + speed * Random(step, node, axis), -15.0, 15.0);
      }
    }
    const auto broken = static_cast<size_t>(frame.frame) * body.edges.size() / 9000;
    frame.broken_edges.resize(std::min(broken, body.edges.size()));
    std::iota(frame.broken_edges.begin(), frame.broken_edges.end(), 0);
    ExpectRoundTrip(encoder, decoder, frame, 1e-4);
    if (HasFailure()) return;
  }
}

TEST_P(Interpolation, HoldsForTinyAndDegenerateBodies) {
  std::vector<Body> bodies = {LatticeBody(1, 1, 1), LatticeBody(2, 1, 1), LatticeBody(9, 9, 1),
                              LatticeBody(40, 1, 1), LatticeBody(3, 3, 3)};
  for (Vec3& x : bodies.back().rest) x = {0.25, 0.25, 0.25};  // all nodes in one place
  for (const Body& body : bodies) {
    FrameEncoder encoder = MakeEncoder(With(body, 1e-4, 5), body.mesh());
    FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
    for (int64_t frame = 0; frame < 12; ++frame) {
      ExpectRoundTrip(encoder, decoder, SwingingFrame(body.rest, frame, body.edges.size()), 1e-4);
    }
  }
}

TEST_P(Interpolation, HoldsAtTheEdgeOfTheGrid) {
  const Body body = LatticeBody(3, 3, 3);
  FrameEncoder encoder = MakeEncoder(With(body, 1e-4, 100), body.mesh());
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
  const StreamHeader& header = decoder.header();
  const double reach = header.UnitOf(1e-4) * (kMaxQuantised - 65);
  Frame frame;
  frame.positions = body.rest;
  for (frame.frame = 0; frame.frame < 6; ++frame.frame) {
    for (size_t node = 0; node < body.rest.size(); ++node) {
      for (size_t axis = 0; axis < 3; ++axis) {
        const bool up = (frame.frame + static_cast<int64_t>(node)) % 2 == 0;
        frame.positions[node][axis] = header.origin[axis] + (up ? reach : -reach);
      }
    }
    const auto encoded = encoder.Encode(frame);
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    ASSERT_TRUE(decoder.Apply(encoded->bytes).ok());
    EXPECT_LE(WorstErrors(frame, decoder.frame()).as_double, 1e-4);
  }
  frame.positions[11][2] = header.origin[2] + 1.001 * reach;
  EXPECT_EQ(encoder.Encode(frame).status().code(), absl::StatusCode::kOutOfRange);
}

TEST_P(Interpolation, ABodyAtRestCostsAtMost200BytesFromTheSecondFrameOn) {
  const Body body = LatticeBody(20, 10, 10);
  FrameEncoder encoder = MakeEncoder(With(body, 1e-4, 1000), body.mesh());
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
  for (int64_t number = 0; number < 40; ++number) {
    Frame frame = BreakingFrame(body, std::min<int64_t>(number, 25));
    frame.frame = number;
    const size_t bytes = ExpectRoundTrip(encoder, decoder, frame, 1e-4);
    if (number > 27) {
      EXPECT_LE(bytes, 200u) << number;
    }
  }
}

TEST_P(Interpolation, SeekingEqualsDecodingStraightAndResumingEqualsNoBreak) {
  const Body body = LatticeBody(10, 6, 4);
  FrameEncoder encoder = MakeEncoder(With(body, 1e-4, 8), body.mesh());
  std::vector<std::string> frames;
  std::vector<std::vector<Vec3>> shown;
  FrameDecoder straight = MakeDecoder(encoder.header_bytes(), body.mesh());
  for (int64_t number = 0; number < 36; ++number) {
    frames.push_back(encoder.Encode(BreakingFrame(body, number))->bytes);
    ASSERT_TRUE(straight.Apply(frames.back()).ok());
    shown.push_back(straight.frame().positions);
  }
  FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
  for (size_t jump = 0; jump < frames.size(); ++jump) {
    const size_t target = jump * 23 % frames.size();  // back and forth
    for (size_t at = target / 8 * 8; at <= target; ++at) {
      ASSERT_TRUE(decoder.Apply(frames[at]).ok()) << at << " on the way to " << target;
    }
    EXPECT_EQ(decoder.frame().positions, shown[target]);
    auto resumed = FrameEncoder::Create(decoder.header(), body.mesh(), decoder.state());
    ASSERT_TRUE(resumed.ok()) << resumed.status();
    for (size_t at = target + 1; at < std::min(target + 3, frames.size()); ++at) {
      EXPECT_EQ(resumed->Encode(BreakingFrame(body, static_cast<int64_t>(at)))->bytes, frames[at]);
    }
  }
}

TEST_P(Interpolation, BytesAreTheSameForAnyNumberOfThreads) {
  const Body body = LatticeBody(40, 16, 16);
  std::vector<std::string> expected;
  for (const int threads : {1, 2, 8}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      StreamParameters parameters = With(body, 1e-4, 6);
      parameters.chunk_nodes = 3000;
      FrameEncoder encoder = MakeEncoder(parameters, body.mesh());
      FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
      std::vector<std::string> frames;
      for (const int64_t number : {0, 5, 9, 12, 31}) {
        frames.push_back(encoder.Encode(BreakingFrame(body, number))->bytes);
        ASSERT_TRUE(decoder.Apply(frames.back()).ok());
      }
      if (expected.empty()) expected = frames;
      EXPECT_EQ(frames, expected) << threads;
    });
  }
}

TEST_P(Interpolation, AMeshWithOtherEdgesIsRefused) {
  const Body body = LatticeBody(4, 3, 3);
  const FrameEncoder encoder = MakeEncoder(With(body, 1e-4, 8), body.mesh());
  const auto expect_refused = [&](const Body& other) {
    EXPECT_EQ(FrameDecoder::Create(encoder.header_bytes(), other.mesh()).status().code(),
              absl::StatusCode::kFailedPrecondition);
  };
  Body other = body;
  other.edges.pop_back();
  expect_refused(other);
  other = body;
  std::swap(other.edges[3], other.edges[4]);
  expect_refused(other);
  other = body;
  other.edges.back()[1] = static_cast<int32_t>(body.rest.size());
  expect_refused(other);
}

INSTANTIATE_TEST_SUITE_P(Coders, Interpolation,
                         ::testing::Values(kCoderZstdPlanes, kCoderContextRans),
                         [](const ::testing::TestParamInfo<uint16_t>& coder) {
                           return "Coder" + std::to_string(coder.param);
                         });

// Most of it rests, a tenth of its nodes lie about: key frames, and the frame in which all of it
// jumps, must not pay for what was before.
TEST(InterpolationSize, ContextsFollowWhatChangesFromOneFrameToTheNext) {
  const Body body = LatticeBody(20, 10, 6);
  std::vector<int32_t> loose;  // edges of every tenth node
  for (size_t edge = 0; edge < body.edges.size(); ++edge) {
    if (body.edges[edge][0] % 10 == 0 || body.edges[edge][1] % 10 == 0) {
      loose.push_back(static_cast<int32_t>(edge));
    }
  }
  std::vector<size_t> sizes;  // of coders 1 and 2
  for (const uint16_t coder : {kCoderZstdPlanes, kCoderContextRans}) {
    StreamParameters parameters = Parameters(body.edges.size(), 1e-5, 12);
    parameters.predictor_id = kPredictorInterpolation;
    parameters.coder_id = coder;
    FrameEncoder encoder = MakeEncoder(parameters, body.mesh());
    FrameDecoder decoder = MakeDecoder(encoder.header_bytes(), body.mesh());
    size_t size = 0;
    for (int64_t number = 0; number < 36; ++number) {
      Frame frame;
      frame.frame = number;
      frame.positions = body.rest;
      frame.broken_edges = loose;
      for (size_t node = 0; node < body.rest.size(); ++node) {
        Vec3& x = frame.positions[node];
        if (node % 10 == 0) {
          x[0] += 0.3 * Random(1, node, 0);
          x[1] += 1e-5 * static_cast<double>(number);
        } else if (number == 17) {
          for (size_t axis = 0; axis < 3; ++axis) x[axis] += 1e-3 * Random(2, node, axis);
        }
      }
      const auto encoded = encoder.Encode(frame);
      ASSERT_TRUE(encoded.ok()) << encoded.status();
      ASSERT_TRUE(decoder.Apply(encoded->bytes).ok());
      size += encoded->bytes.size();
    }
    sizes.push_back(size);
  }
  EXPECT_LT(sizes[1], sizes[0] * 9 / 10);
}

TEST(InterpolationState, OneOfAnotherCoderIsRefused) {
  const Body body = LatticeBody(4, 3, 3);
  StreamParameters parameters = Parameters(body.edges.size(), 1e-4, 100);
  parameters.predictor_id = kPredictorInterpolation;
  FrameEncoder encoder = MakeEncoder(parameters, body.mesh());
  for (int64_t number = 0; number < 2; ++number) {
    ASSERT_TRUE(encoder.Encode(BreakingFrame(body, number)).ok());
  }
  parameters.coder_id = kCoderContextRans;
  const auto header = MakeStreamHeader(parameters, body.rest);
  ASSERT_TRUE(header.ok()) << header.status();
  const absl::Status status = FrameEncoder::Create(*header, body.mesh(), encoder.state()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition) << status;
}

// The piece of each place, by the way of its unbroken edges to earlier places.
std::vector<int32_t> FloodedPieces(const NodeOrder& order, const Body& body,
                                   const std::vector<int32_t>& broken) {
  std::vector<int32_t> places(order.nodes.size());
  for (size_t place = 0; place < places.size(); ++place) {
    places[static_cast<size_t>(order.nodes[place])] = static_cast<int32_t>(place);
  }
  std::vector<int32_t> first(places.size());
  std::iota(first.begin(), first.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t edge = 0; edge < body.edges.size(); ++edge) {
      if (std::binary_search(broken.begin(), broken.end(), static_cast<int32_t>(edge))) continue;
      int32_t& a = first[static_cast<size_t>(places[static_cast<size_t>(body.edges[edge][0])])];
      int32_t& b = first[static_cast<size_t>(places[static_cast<size_t>(body.edges[edge][1])])];
      changed |= a != b;
      a = b = std::min(a, b);
    }
  }
  std::vector<int32_t> leaders = first;
  std::sort(leaders.begin(), leaders.end());
  leaders.erase(std::unique(leaders.begin(), leaders.end()), leaders.end());
  for (int32_t& place : first) {
    place = static_cast<int32_t>(std::lower_bound(leaders.begin(), leaders.end(), place) -
                                 leaders.begin());
  }
  return first;
}

TEST(Stencils, AreThoseOfTheBrokenEdgesHoweverTheseCameAbout) {
  const Body body = LatticeBody(9, 8, 7);
  const NodeOrder order = MakeNodeOrder(body.rest);
  std::vector<Vec3> by_place;
  for (const int32_t node : order.nodes) by_place.push_back(body.rest[static_cast<size_t>(node)]);
  Stencils kept(order, by_place, body.edges);
  std::vector<int32_t> broken;
  for (uint64_t round = 0; round < 24; ++round) {
    if (round == 12) broken.clear();  // a rewind
    std::vector<int32_t> more;
    const double where = Random(round, 0, 0);
    for (size_t edge = 0; edge < body.edges.size(); ++edge) {
      // Scattered edges at first, later whole walls.
      const double a = body.rest[static_cast<size_t>(body.edges[edge][0])][round % 3] - 0.3;
      const double b = body.rest[static_cast<size_t>(body.edges[edge][1])][round % 3] - 0.3;
      const bool wall = round % 12 > 3 && (a < 0.3 * where) != (b < 0.3 * where);
      if (wall || Random(round, edge, 1) > 0.97) more.push_back(static_cast<int32_t>(edge));
    }
    std::vector<int32_t> all;
    std::set_union(broken.begin(), broken.end(), more.begin(), more.end(), std::back_inserter(all));
    broken = all;
    kept.SetBroken(order, broken);
    Stencils fresh(order, by_place, body.edges);
    fresh.SetBroken(order, {});
    // From nothing in one go, by way of another set that has to heal.
    fresh.SetBroken(order, std::vector<int32_t>{0, 7, 100});
    fresh.SetBroken(order, broken);
    EXPECT_EQ(kept.pieces().labels(), FloodedPieces(order, body, broken));
    EXPECT_EQ(kept.pieces().labels(), fresh.pieces().labels());
    EXPECT_EQ(kept.pieces().leaders(), fresh.pieces().leaders());
    for (int32_t place = 0; place < static_cast<int32_t>(by_place.size()); ++place) {
      ASSERT_EQ(kept[place].places, fresh[place].places) << place << " in round " << round;
      ASSERT_EQ(kept[place].weights, fresh[place].weights) << place << " in round " << round;
      EXPECT_EQ(kept[place].leads(),
                kept.pieces().leaders()[static_cast<size_t>(kept.pieces()[place])] == place);
    }
  }
  EXPECT_GT(kept.pieces().count(), 20);
}

TEST(Stencils, ReproduceAffineMaps) {
  const Body body = LatticeBody(9, 8, 7);
  const NodeOrder order = MakeNodeOrder(body.rest);
  std::vector<Vec3> by_place;
  for (const int32_t node : order.nodes) by_place.push_back(body.rest[static_cast<size_t>(node)]);
  const Stencils stencils(order, by_place, body.edges);
  for (int32_t place = order.group_begins[order.GroupOf(200)];
       place < static_cast<int32_t>(by_place.size()); ++place) {
    Vec3 blend{};
    int32_t sum = 0;
    for (size_t k = 0; k < kStencilNodes; ++k) {
      sum += stencils[place].weights[k];
      for (size_t axis = 0; axis < 3; ++axis) {
        blend[axis] += stencils[place].weights[k] / 32768.0 *
                       by_place[static_cast<size_t>(stencils[place].places[k])][axis];
      }
    }
    EXPECT_EQ(sum, kStencilOne);
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(blend[axis], by_place[static_cast<size_t>(place)][axis], 2e-3);
    }
  }
}

}  // namespace
}  // namespace cleave
