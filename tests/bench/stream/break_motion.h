#ifndef CLEAVE_TESTS_BENCH_STREAM_BREAK_MOTION_H_
#define CLEAVE_TESTS_BENCH_STREAM_BREAK_MOTION_H_

#include <cstdint>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame.h"

namespace cleave {

// A bar that swings, cracks along the walls between random cells over some frames, and falls apart
// into pieces that tumble and ring: a motion given by formulas, of any size, at 24 frames a second.
struct BreakingBar {
  TetMesh mesh;
  Incidence incidence;
  std::vector<int> pieces;            // of each node
  std::vector<Vec3> centres;          // m, of each piece
  std::vector<int64_t> break_frames;  // of each edge; past the end for those that hold

  static constexpr int64_t kFirstBreak = 32;
  static constexpr int64_t kLastBreak = 46;
};

BreakingBar MakeBreakingBar(int cells_across);

// Where everything is in a frame. `noise` (m) is added to each coordinate, uniform.
void MoveBar(const BreakingBar& bar, int64_t number, double noise, Frame& frame);

}  // namespace cleave

#endif  // CLEAVE_TESTS_BENCH_STREAM_BREAK_MOTION_H_
