#include "tests/bench/stream/break_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/counter_rng.h"
#include "core/mesh/procedural.h"

namespace cleave {
namespace {

constexpr int kPieces = 40;

double Random(uint64_t index, uint64_t subindex) {
  return 2 * UniformDraw(11, RandomStream::kMeshJitter, index, subindex) - 1;
}

double Distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

BreakingBar MakeBreakingBar(int cells_across) {
  BreakingBar bar;
  BoxMesh box;
  box.size = {4, 1, 1};
  box.resolution.layout = MeshLayout::kJitteredLattice;
  box.resolution.cell_size = 1.0 / cells_across;
  bar.mesh = *BuildMesh(box);
  bar.incidence = BuildIncidence(bar.mesh);
  for (uint64_t piece = 0; piece < kPieces; ++piece) {
    bar.centres.push_back(
        {2 + 2 * Random(piece, 0), 0.5 + 0.5 * Random(piece, 1), 0.5 + 0.5 * Random(piece, 2)});
  }
  for (const Vec3& x : bar.mesh.rest_positions) {
    int nearest = 0;
    for (int piece = 1; piece < kPieces; ++piece) {
      if (Distance(x, bar.centres[static_cast<size_t>(piece)]) <
          Distance(x, bar.centres[static_cast<size_t>(nearest)])) {
        nearest = piece;
      }
    }
    bar.pieces.push_back(nearest);
  }
  constexpr double kFrames = BreakingBar::kLastBreak - BreakingBar::kFirstBreak;
  for (const auto& [a, b] : bar.incidence.edges) {
    const double share =
        Distance(bar.mesh.rest_positions[static_cast<size_t>(a)], {2, 1, 0.5}) / 2.4;
    const bool breaks = bar.pieces[static_cast<size_t>(a)] != bar.pieces[static_cast<size_t>(b)];
    bar.break_frames.push_back(breaks ? BreakingBar::kFirstBreak +
                                            static_cast<int64_t>(kFrames * std::min(share, 0.99))
                                      : INT64_MAX);
  }
  return bar;
}

void MoveBar(const BreakingBar& bar, int64_t number, double noise, Frame& frame) {
  const double t = static_cast<double>(number) / 24;
  const double since = std::max(0.0, static_cast<double>(number - BreakingBar::kLastBreak) / 24);
  frame.frame = number;
  frame.time = t;
  frame.fragments = number < BreakingBar::kLastBreak ? 1 : kPieces;
  const std::vector<Vec3>& rest = bar.mesh.rest_positions;
  frame.positions.resize(rest.size());
  for (size_t node = 0; node < rest.size(); ++node) {
    const Vec3& x = rest[node];
    const auto piece = static_cast<uint64_t>(bar.pieces[node]);
    const Vec3& c = bar.centres[piece];
    const double angle = 4 * Random(piece, 7) * since;
    const double dx = x[0] - c[0];
    const double dy = x[1] - c[1];
    // Elastic waves that die out, and the noise of a solver.
    const double ring = 0.003 * std::sin(40 * t + 5 * x[0] + 3 * x[2]) * std::exp(-since);
    frame.positions[node] = {
        c[0] + std::cos(angle) * dx - std::sin(angle) * dy + Random(piece, 8) * since + ring,
        c[1] + std::sin(angle) * dx + std::cos(angle) * dy + Random(piece, 9) * since +
            0.02 * std::sin(2 * t) * x[0] * x[0],
        x[2] + Random(piece, 10) * since - 4.9 * since * since + 0.3 * ring};
    if (noise > 0) {
      for (size_t axis = 0; axis < 3; ++axis) {
        frame.positions[node][axis] +=
            noise * Random(1000 + node, static_cast<uint64_t>(number) * 3 + axis);
      }
    }
  }
  frame.broken_edges.clear();
  for (size_t edge = 0; edge < bar.break_frames.size(); ++edge) {
    if (bar.break_frames[edge] <= number) frame.broken_edges.push_back(static_cast<int32_t>(edge));
  }
}

}  // namespace cleave
