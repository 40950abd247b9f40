// Writes the golden stream, its rest positions and the positions that were encoded.

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/sha256.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "core/stream/stream_file.h"
#include "tests/unit/core/stream/golden_scene.h"

namespace cleave::stream_test {
namespace {

std::vector<Vec3> GoldenRest() {
  std::vector<Vec3> rest;
  for (int node = 0; node < kGoldenNodes; ++node) {
    rest.push_back({node / 9 * 0.1, node / 3 % 3 * 0.11 - 2, node % 3 * 0.12 + 5});
  }
  return rest;
}

Frame GoldenFrame(const std::vector<Vec3>& rest, int64_t number) {
  Frame frame;
  frame.frame = number;
  frame.time = static_cast<double>(number) / 24;
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

void Save(const std::string& name, const std::string& bytes) {
  std::ofstream(kGoldenDirectory + name, std::ios::binary) << bytes;
}

std::string Raw(const std::vector<Vec3>& positions) {
  return std::string(reinterpret_cast<const char*>(positions.data()),
                     positions.size() * sizeof(Vec3));
}

absl::Status Write() {
  const std::vector<Vec3> rest = GoldenRest();
  const auto header = MakeStreamHeader({.mesh_sha256 = std::string(32, '\x5a'),
                                        .edge_count = 200,
                                        .tet_count = 120,
                                        .tolerance = kGoldenTolerance,
                                        .keyframe_interval = 5,
                                        .chunk_nodes = 60},
                                       rest);
  if (!header.ok()) return header.status();
  auto encoder = FrameEncoder::Create(*header, rest);
  if (!encoder.ok()) return encoder.status();
  std::string stream = encoder->header_bytes();
  StreamFileIndex index(stream);
  auto decoder = FrameDecoder::Create(stream, rest);
  if (!decoder.ok()) return decoder.status();
  std::string expected;
  std::string decoded;
  std::vector<int64_t> numbers = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 7, 8, 9};
  for (size_t at = 0; at < numbers.size(); ++at) {
    absl::Status status;
    if (at == 10) status.Update(encoder->StartEpoch(1));
    if (at == 12) status.Update(encoder->SetTolerance(kGoldenFinerTolerance));
    if (!status.ok()) return status;
    const Frame frame = GoldenFrame(rest, numbers[at]);
    const auto encoded = encoder->Encode(frame);
    if (!encoded.ok()) return encoded.status();
    status.Update(index.Add(encoded->bytes));
    status.Update(decoder->Apply(encoded->bytes));
    if (!status.ok()) return status;
    stream += encoded->bytes;
    expected += Raw(frame.positions);
    decoded += Raw(decoder->frame().positions);
  }
  Save("temporal_zstd.clv", stream + index.Footer());
  Save("temporal_zstd.rest", Raw(rest));
  Save("temporal_zstd.expected", expected);
  Save("temporal_zstd.decoded_sha256", Sha256::Of(decoded));
  return absl::OkStatus();
}

}  // namespace
}  // namespace cleave::stream_test

int main() {
  const absl::Status status = cleave::stream_test::Write();
  if (!status.ok()) std::cerr << status << "\n";
  return status.ok() ? 0 : 1;
}
