// Writes the golden streams that it is given the names of, their meshes and the positions that were
// encoded. For new ids only: what is in golden/ stays.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/base/sha256.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "core/stream/stream_file.h"
#include "tests/unit/core/stream/golden_scene.h"

namespace cleave::stream_test {
namespace {

using Edge = std::array<int32_t, 2>;

// What a stream is made of.
struct GoldenBody {
  std::vector<Vec3> rest;
  std::vector<Edge> edges;
  std::vector<std::array<int32_t, 4>> tets;
};

GoldenBody TemporalBody() {
  GoldenBody body;
  for (int node = 0; node < 90; ++node) {
    body.rest.push_back({node / 9 * 0.1, node / 3 % 3 * 0.11 - 2, node % 3 * 0.12 + 5});
  }
  body.edges.resize(200);
  return body;
}

Frame TemporalFrame(const GoldenBody& body, int64_t number) {
  const std::vector<Vec3>& rest = body.rest;
  Frame frame;
  frame.fragments = number < 4 ? 1 : 2;
  frame.positions = rest;
  const auto t = static_cast<double>(number == 3 ? 2 : number);
  for (size_t node = 0; node < rest.size(); ++node) {
    Vec3& x = frame.positions[node];
    if (node < 45) {
      x[0] -= 0.004 * t * t + 1e-4 * std::sin(static_cast<double>(7 * node) + t);
    } else {
      x[0] += 0.02 * t;
      x[2] -= 0.3 * std::sin(t * rest[node][0]);
    }
  }
  for (int32_t edge = 0; edge < 200; ++edge) {
    if ((edge * 37) % 200 < (number <= 3 ? 0 : 25 * (number - 3))) {
      frame.broken_edges.push_back(edge);
    }
  }
  return frame;
}

// A jittered lattice of 8 x 5 x 5 nodes, each cell cut into six tets.
GoldenBody LatticeBody() {
  GoldenBody body;
  for (int node = 0; node < 200; ++node) {
    const auto jitter = [node](uint64_t axis) {
      return 0.03 *
             (UniformDraw(5, RandomStream::kMeshJitter, static_cast<uint64_t>(node), axis) - 0.5);
    };
    body.rest.push_back({node / 25 * 0.1 + jitter(0), node / 5 % 5 * 0.11 - 2 + jitter(1),
                         node % 5 * 0.12 + 5 + jitter(2)});
  }
  for (int32_t node = 0; node < 200; ++node) {
    for (int corner = 1; corner < 8; ++corner) {
      const int x = node / 25 + (corner >> 2);
      const int y = node / 5 % 5 + (corner >> 1 & 1);
      const int z = node % 5 + (corner & 1);
      if (x < 8 && y < 5 && z < 5) body.edges.push_back({node, 25 * x + 5 * y + z});
    }
  }
  std::sort(body.edges.begin(), body.edges.end());
  for (int32_t cell = 0; cell < 7 * 4 * 4; ++cell) {
    const int32_t first = 25 * (cell / 16) + 5 * (cell / 4 % 4) + cell % 4;
    std::array<int32_t, 3> steps = {1, 5, 25};
    do {
      body.tets.push_back({first, first + steps[0], first + steps[0] + steps[1], first + 31});
    } while (std::next_permutation(steps.begin(), steps.end()));
  }
  return body;
}

// The nearest of twelve nodes.
size_t CellOf(const GoldenBody& body, size_t node) {
  size_t nearest = 0;
  double least = 1e9;
  for (size_t cell = 0; cell < 12; ++cell) {
    const Vec3& centre = body.rest[cell * 97 % 200];
    double square = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double d = body.rest[node][axis] - centre[axis];
      square += d * d;
    }
    if (square < least) {
      least = square;
      nearest = cell;
    }
  }
  return nearest;
}

// The body bends; a crack opens across it from frame 4 to 6; from 7 on node 0 is alone, from 8 on
// the small part rests, and in the last frame of epoch 1 nothing holds together.
Frame LatticeFrame(const GoldenBody& body, int64_t number, bool shattered, bool crumbles) {
  Frame frame;
  frame.positions = body.rest;
  const auto t = static_cast<double>(number == 3 ? 2 : number);
  for (size_t node = 0; node < body.rest.size(); ++node) {
    const Vec3& rest = body.rest[node];
    Vec3& x = frame.positions[node];
    if (node == 0 && number >= 7) {
      x[1] -= 0.3 * t;
    } else if (node < 75) {
      x[0] -= number >= 8 ? 0.1 : 0.004 * t * t;
      x[1] += number >= 8 ? 0 : 0.05 * std::sin(t) * rest[0] * rest[2];
    } else {
      const double angle = number < 7 ? 0 : 0.1 * (t - 6);
      x[0] = 0.5 + std::cos(angle) * (rest[0] - 0.5) - std::sin(angle) * (rest[1] + 2) + 0.01 * t;
      x[1] = -2 + std::sin(angle) * (rest[0] - 0.5) + std::cos(angle) * (rest[1] + 2);
      x[2] += 0.05 * std::sin(t + 3 * rest[0]);
    }
  }
  for (size_t edge = 0; edge < body.edges.size(); ++edge) {
    const auto& [a, b] = body.edges[edge];
    const bool crack = a < 75 && b >= 75 && a % 25 < 10 * (number - 3);
    const bool between =
        crumbles && number >= 5 &&
        CellOf(body, static_cast<size_t>(a)) != CellOf(body, static_cast<size_t>(b));
    if (shattered || crack || between || (a == 0 && number >= 7)) {
      frame.broken_edges.push_back(static_cast<int32_t>(edge));
    }
  }
  frame.fragments = shattered ? 200 : 1 + (number >= 6 ? 1 : 0) + (number >= 7 ? 1 : 0);
  return frame;
}

void Save(const std::string& name, const std::string& bytes) {
  std::ofstream(kGoldenDirectory + name, std::ios::binary) << bytes;
}

std::string Raw(const std::vector<Vec3>& positions) {
  return std::string(reinterpret_cast<const char*>(positions.data()),
                     positions.size() * sizeof(Vec3));
}

absl::Status Write(const GoldenStream& golden) {
  const bool lattice = golden.interpolates();
  const GoldenBody body = lattice ? LatticeBody() : TemporalBody();
  const auto header = MakeStreamHeader({.mesh_sha256 = std::string(32, '\x5a'),
                                        .edge_count = body.edges.size(),
                                        .tet_count = golden.surface ? body.tets.size() : 120,
                                        .tolerance = golden.exact() ? 0 : kGoldenTolerance,
                                        .keyframe_interval = 5,
                                        .chunk_nodes = 60,
                                        .predictor_id = golden.predictor_id,
                                        .coder_id = golden.coder_id,
                                        .view_id = golden.surface ? kViewSurface : kViewState,
                                        .regions = golden.regions},
                                       body.rest);
  if (!header.ok()) return header.status();
  const StreamMesh mesh(body.rest, body.edges, body.tets);
  auto encoder = FrameEncoder::Create(*header, mesh);
  if (!encoder.ok()) return encoder.status();
  std::string stream = encoder->header_bytes();
  StreamFileIndex index(stream);
  auto decoder = FrameDecoder::Create(stream, mesh);
  if (!decoder.ok()) return decoder.status();
  std::string expected;
  std::string decoded;
  std::vector<int64_t> numbers = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 7, 8, 9};
  for (size_t at = 0; at < numbers.size(); ++at) {
    absl::Status status;
    if (at == 10) status.Update(encoder->StartEpoch(1));
    if (at == 12 && !golden.exact()) status.Update(encoder->SetTolerance(kGoldenFinerTolerance));
    if (golden.regions && at == 4) {
      status.Update(
          encoder->SetRegion(Region{.nodes = {199}, .outside_tolerance = kGoldenOutsideTolerance}));
    }
    if (golden.regions && at == 9) {
      status.Update(
          encoder->SetRegion(Region{.nodes = {},
                                    .box = std::array<Vec3, 2>{Vec3{-1, -3, 4}, Vec3{0.2, 0, 6}},
                                    .outside_tolerance = kGoldenOutsideTolerance}));
    }
    if (!status.ok()) return status;
    Frame frame = lattice ? LatticeFrame(body, numbers[at], at == 12, golden.crumbles)
                          : TemporalFrame(body, numbers[at]);
    frame.frame = numbers[at];
    frame.time = static_cast<double>(frame.frame) / 24;
    const auto encoded = encoder->Encode(frame);
    if (!encoded.ok()) return encoded.status();
    status.Update(index.Add(encoded->bytes));
    status.Update(decoder->Apply(encoded->bytes));
    if (!status.ok()) return status;
    stream += encoded->bytes;
    expected += Raw(frame.positions);
    decoded += Raw(decoder->frame().positions);
  }
  const std::string name = golden.name;
  Save(name + ".clv", stream + index.Footer());
  Save(name + ".rest", Raw(body.rest));
  if (lattice) {
    Save(name + ".edges", std::string(reinterpret_cast<const char*>(body.edges.data()),
                                      body.edges.size() * sizeof(Edge)));
  }
  if (golden.surface) {
    Save(name + ".tets", std::string(reinterpret_cast<const char*>(body.tets.data()),
                                     body.tets.size() * sizeof(body.tets[0])));
  }
  Save(name + ".expected", expected);
  Save(name + ".decoded_sha256", Sha256::Of(decoded));
  std::cout << name << ": " << stream.size() << " bytes, " << decoder->frame().broken_edges.size()
            << " edges broken\n";
  return absl::OkStatus();
}

}  // namespace
}  // namespace cleave::stream_test

int main(int count, char** names) {
  for (int at = 1; at < count; ++at) {
    for (const cleave::stream_test::GoldenStream& golden : cleave::stream_test::kGoldenStreams) {
      if (std::string(names[at]) != golden.name) continue;
      const absl::Status status = cleave::stream_test::Write(golden);
      if (!status.ok()) {
        std::cerr << status << "\n";
        return 1;
      }
    }
  }
}
