#ifndef CLEAVE_TESTS_UNIT_CORE_STREAM_STREAM_FIXTURE_H_
#define CLEAVE_TESTS_UNIT_CORE_STREAM_STREAM_FIXTURE_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/counter_rng.h"
#include "core/stream/frame.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "core/stream/stream_header.h"
#include "gtest/gtest.h"

namespace cleave::stream_test {

// A uniform number in (-1, 1) for anything that a test moves at random.
inline double Random(uint64_t seed, uint64_t index, uint64_t subindex) {
  return 2 * UniformDraw(seed, RandomStream::kMeshJitter, index, subindex) - 1;
}

inline std::vector<Vec3> RandomBody(size_t nodes, uint64_t seed = 1) {
  std::vector<Vec3> rest(nodes);
  for (size_t node = 0; node < nodes; ++node) {
    for (size_t axis = 0; axis < 3; ++axis) rest[node][axis] = Random(seed, node, axis);
  }
  return rest;
}

// Nodes, the edges between them, and the tets that have these.
struct Body {
  std::vector<Vec3> rest;
  std::vector<std::array<int32_t, 2>> edges;
  std::vector<std::array<int32_t, 4>> tets;

  StreamMesh mesh() const { return {rest, edges, tets}; }
};

// A jittered lattice, its cells cut into six tets each.
inline Body LatticeBody(int x_nodes, int y_nodes, int z_nodes) {
  Body body;
  for (int x = 0; x < x_nodes; ++x) {
    for (int y = 0; y < y_nodes; ++y) {
      for (int z = 0; z < z_nodes; ++z) {
        const auto node = static_cast<int32_t>(body.rest.size());
        const auto jitter = [node](uint64_t axis) {
          return 0.02 * Random(5, static_cast<uint64_t>(node), axis);
        };
        body.rest.push_back({0.1 * x + jitter(0), 0.1 * y + jitter(1), 0.1 * z + jitter(2)});
        for (int corner = 1; corner < 8; ++corner) {
          const int dx = corner >> 2;
          const int dy = corner >> 1 & 1;
          const int dz = corner & 1;
          if (x + dx < x_nodes && y + dy < y_nodes && z + dz < z_nodes) {
            body.edges.push_back({node, node + (dx * y_nodes + dy) * z_nodes + dz});
          }
        }
      }
    }
  }
  std::sort(body.edges.begin(), body.edges.end());
  for (int cell = 0; cell < (x_nodes - 1) * (y_nodes - 1) * (z_nodes - 1); ++cell) {
    const int x = cell / (z_nodes - 1) / (y_nodes - 1);
    const int y = cell / (z_nodes - 1) % (y_nodes - 1);
    const int first = (x * y_nodes + y) * z_nodes + cell % (z_nodes - 1);
    std::array<int, 3> steps = {1, z_nodes, y_nodes * z_nodes};
    do {
      body.tets.push_back({first, first + steps[0], first + steps[0] + steps[1],
                           first + steps[0] + steps[1] + steps[2]});
    } while (std::next_permutation(steps.begin(), steps.end()));
  }
  return body;
}

inline StreamParameters Parameters(uint64_t edges, double tolerance, uint32_t keyframe_interval) {
  return {.mesh_sha256 = std::string(32, 'm'),
          .edge_count = edges,
          .tet_count = edges,
          .tolerance = tolerance,
          .keyframe_interval = keyframe_interval,
          .chunk_nodes = 100};
}

// A body that swings, drifts and loses edges: frame after frame of it.
inline Frame SwingingFrame(const std::vector<Vec3>& rest, int64_t frame, uint64_t edges) {
  Frame out;
  out.frame = frame;
  out.time = static_cast<double>(frame) / 24;
  out.fragments = 1 + frame / 4;
  out.positions = rest;
  const double t = out.time;
  for (size_t node = 0; node < rest.size(); ++node) {
    out.positions[node][0] += 0.3 * std::sin(3 * t + 2 * rest[node][1]);
    out.positions[node][1] += 0.05 * t * t * rest[node][2];
    out.positions[node][2] += 0.02 * Random(7, node, static_cast<uint64_t>(frame));
  }
  for (uint64_t edge = 0; edge < edges; ++edge) {
    if (30 * (Random(3, edge, 0) + 1) < static_cast<double>(frame) - 2) {
      out.broken_edges.push_back(static_cast<int32_t>(edge));
    }
  }
  return out;
}

inline FrameEncoder MakeEncoder(const StreamParameters& parameters, const StreamMesh& mesh) {
  absl::StatusOr<StreamHeader> header = MakeStreamHeader(parameters, mesh.rest_positions);
  EXPECT_TRUE(header.ok()) << header.status();
  absl::StatusOr<FrameEncoder> encoder = FrameEncoder::Create(*header, mesh);
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  return *std::move(encoder);
}

inline FrameDecoder MakeDecoder(const std::string& header, const StreamMesh& mesh) {
  absl::StatusOr<FrameDecoder> decoder = FrameDecoder::Create(header, mesh);
  EXPECT_TRUE(decoder.ok()) << decoder.status();
  return *std::move(decoder);
}

// The worst error of a coordinate, m: in doubles and after rounding to float32.
struct Errors {
  double as_double = 0;
  double as_float = 0;
};
inline Errors WorstErrors(const Frame& original, const Frame& decoded) {
  Errors worst;
  for (size_t node = 0; node < original.positions.size(); ++node) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const double x = original.positions[node][axis];
      const double y = decoded.positions[node][axis];
      worst.as_double = std::max(worst.as_double, std::abs(y - x));
      worst.as_float =
          std::max(worst.as_float, std::abs(static_cast<double>(static_cast<float>(y)) - x));
    }
  }
  return worst;
}

}  // namespace cleave::stream_test

#endif  // CLEAVE_TESTS_UNIT_CORE_STREAM_STREAM_FIXTURE_H_
