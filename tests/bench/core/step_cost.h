#ifndef CLEAVE_TESTS_BENCH_CORE_STEP_COST_H_
#define CLEAVE_TESTS_BENCH_CORE_STEP_COST_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// A scene of a table, run on so many threads.
struct BenchCase {
  std::string name;
  Scene scene;
  int threads = 1;
};

// What a case took over its frames.
struct StepCost {
  int steps = 0;
  int newton_iterations = 0;
  int linear_iterations = 0;
  long long broken_edges = 0;
  // s, all steps together: of each frame the least of the rounds, as whatever else the machine does
  // only adds.
  double total = 0, assembly = 0, linear = 0, fracture = 0;
};

// Runs all cases on `mesh` for `frames` frames, in as many rounds, case by case in each, so that a
// machine that slows down slows all of them. One result a case.
absl::StatusOr<std::vector<StepCost>> MeasureSteps(const TetMesh& mesh,
                                                   const std::vector<BenchCase>& cases, int frames,
                                                   int rounds);

// Prints a table of what steps cost as shares of the first case.
absl::Status PrintRatios();
// Prints what solves of a slab that tears take with fibres and without (tests/scenes/slab_trio.h).
absl::Status PrintSlab();
// Prints steps of blocks that rest, asleep against awake.
absl::Status PrintSleep();
// Prints what the surface and the pieces cost while a bar is cut, followed and found anew.
absl::Status PrintSurface();
// Prints the step of 1/60 s of a column of 40 thousand tets, one Newton iteration, with its split.
absl::Status PrintColumn();

}  // namespace cleave

#endif  // CLEAVE_TESTS_BENCH_CORE_STEP_COST_H_
