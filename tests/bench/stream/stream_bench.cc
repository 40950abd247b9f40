// Size and speed of the frame stream on a synthetic break: a bar bends, then falls apart into
// pieces that tumble and fall. Prints a table; asserts nothing.

#include <tbb/task_arena.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/base/stopwatch.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"

namespace cleave {
namespace {

constexpr int64_t kFrames = 96;
constexpr int64_t kBreakFrame = 32;
constexpr int kPieces = 40;

double Random(uint64_t index, uint64_t subindex) {
  return 2 * UniformDraw(11, RandomStream::kMeshJitter, index, subindex) - 1;
}

struct Body {
  std::vector<Vec3> rest;   // m
  std::vector<int> pieces;  // of each node, by the nearest of random centres
  std::vector<Vec3> centres;
};

// A bar of n nodes across, 4 n along, jittered.
Body MakeBody(int across) {
  Body body;
  for (uint64_t piece = 0; piece < kPieces; ++piece) {
    body.centres.push_back({2 + 2 * Random(piece, 0), Random(piece, 1), Random(piece, 2)});
  }
  for (int x = 0; x < 4 * across; ++x) {
    for (int y = 0; y < across; ++y) {
      for (int z = 0; z < across; ++z) {
        const auto node = static_cast<uint64_t>(body.rest.size()) + 1000;
        const double h = 1.0 / across;
        Vec3 at = {h * (x + 0.3 * Random(node, 0)), h * (y + 0.3 * Random(node, 1)),
                   h * (z + 0.3 * Random(node, 2))};
        int nearest = 0;
        double least = 1e9;
        for (int piece = 0; piece < kPieces; ++piece) {
          const Vec3& c = body.centres[static_cast<size_t>(piece)];
          const double distance = std::hypot(c[0] - at[0], c[1] - at[1], c[2] - at[2]);
          if (distance < least) {
            least = distance;
            nearest = piece;
          }
        }
        body.rest.push_back(at);
        body.pieces.push_back(nearest);
      }
    }
  }
  return body;
}

void MoveBody(const Body& body, int64_t number, Frame& frame) {
  const double t = static_cast<double>(number) / 24;
  const double since = std::max(0.0, static_cast<double>(number - kBreakFrame) / 24);
  frame.frame = number;
  frame.time = t;
  frame.positions.resize(body.rest.size());
  for (size_t node = 0; node < body.rest.size(); ++node) {
    const Vec3& x = body.rest[node];
    const auto piece = static_cast<uint64_t>(body.pieces[node]);
    const Vec3& c = body.centres[piece];
    const double angle = 4 * Random(piece, 7) * since;
    const double dx = x[0] - c[0];
    const double dy = x[1] - c[1];
    // Ringing: elastic waves that die out.
    const double ring = 0.003 * std::sin(40 * t + 5 * x[0] + 3 * x[2]) * std::exp(-since);
    frame.positions[node] = {
        c[0] + std::cos(angle) * dx - std::sin(angle) * dy + Random(piece, 8) * since + ring,
        c[1] + std::sin(angle) * dx + std::cos(angle) * dy + Random(piece, 9) * since +
            0.02 * std::sin(2 * t) * x[0] * x[0],
        x[2] + Random(piece, 10) * since - 4.9 * since * since + 0.3 * ring};
  }
}

void Measure(int across, double share, int threads) {
  const Body body = MakeBody(across);
  const double diagonal = std::hypot(4.0, 1.0, 1.0);
  const auto header = MakeStreamHeader({.mesh_sha256 = std::string(32, 'm'),
                                        .edge_count = 7 * body.rest.size(),
                                        .tet_count = 5 * body.rest.size(),
                                        .tolerance = share * diagonal},
                                       body.rest);
  auto encoder = FrameEncoder::Create(*header, body.rest);
  auto decoder = FrameDecoder::Create(encoder->header_bytes(), body.rest);
  double encode_seconds = 0;
  double decode_seconds = 0;
  size_t key_bytes = 0;
  size_t keys = 0;
  size_t delta_bytes = 0;
  Frame frame;
  tbb::task_arena(threads).execute([&] {
    for (int64_t number = 0; number < kFrames; ++number) {
      MoveBody(body, number, frame);
      const Stopwatch encoding;
      const auto encoded = encoder->Encode(frame);
      encode_seconds += encoding.Seconds();
      const Stopwatch decoding;
      const absl::Status applied = decoder->Apply(encoded->bytes);
      decode_seconds += decoding.Seconds();
      if (!applied.ok()) std::printf("%s\n", applied.ToString().c_str());
      const bool key = encoded->header.kind == FrameKind::kKey;
      keys += key ? 1 : 0;
      (key ? key_bytes : delta_bytes) += encoded->bytes.size();
    }
  });
  const auto nodes = static_cast<double>(body.rest.size());
  const double megabytes = 12e-6 * nodes * kFrames;  // as float32
  std::printf("%8.0f  %7.0e  %7d  %10.3f  %10.3f  %10.1f  %10.1f\n", nodes, share, threads,
              static_cast<double>(key_bytes) / static_cast<double>(keys) / nodes,
              static_cast<double>(delta_bytes) / static_cast<double>(kFrames - keys) / nodes,
              megabytes / encode_seconds, megabytes / decode_seconds);
}

}  // namespace
}  // namespace cleave

int main() {
  std::printf("   nodes  tol / D  threads     key B/v   delta B/v  enc. MB/s  dec. MB/s\n");
  for (const int across : {17, 37}) {
    for (const double share : {1e-3, 1e-4, 1e-5}) cleave::Measure(across, share, 1);
    cleave::Measure(across, 1e-4, 2);
  }
}
