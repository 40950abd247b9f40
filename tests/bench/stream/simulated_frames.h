#ifndef CLEAVE_TESTS_BENCH_STREAM_SIMULATED_FRAMES_H_
#define CLEAVE_TESTS_BENCH_STREAM_SIMULATED_FRAMES_H_

#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame.h"

namespace cleave {

// Frames of Cleave's own solver: a bar of brittle plastic, pulled until it breaks, then falling.
struct SimulatedFrames {
  TetMesh mesh;
  Incidence incidence;
  std::vector<Frame> frames;
};

SimulatedFrames SimulateBreakingBar();

}  // namespace cleave

#endif  // CLEAVE_TESTS_BENCH_STREAM_SIMULATED_FRAMES_H_
