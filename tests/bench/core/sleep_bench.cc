#include <tbb/global_control.h>

#include <cstdio>
#include <memory>

#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "core/simulation/simulation.h"
#include "tests/bench/core/step_cost.h"

namespace cleave {
namespace {

constexpr int kPieces = 20;

// Blocks of rubber on the ground, the last of them so many metres above it.
absl::StatusOr<TetMesh> Blocks(double height) {
  TetMesh mesh;
  for (int block = 0; block < kPieces; ++block) {
    BoxMesh box;
    box.origin = {0.2 * (block % 5), 0.2 * (block / 5), block == kPieces - 1 ? height : 0.0};
    box.size = {0.1, 0.1, 0.1};
    box.resolution.cell_size = 0.1 / 4;
    CLEAVE_ASSIGN_OR_RETURN(const TetMesh one, BuildMesh(box));
    const auto offset = static_cast<int32_t>(mesh.node_count());
    mesh.rest_positions.insert(mesh.rest_positions.end(), one.rest_positions.begin(),
                               one.rest_positions.end());
    for (auto tet : one.tets) {
      for (int32_t& node : tet) node += offset;
      mesh.tets.push_back(tet);
    }
  }
  return mesh;
}

Scene OnTheGround(bool sleep) {
  Scene scene;
  Material rubber;
  rubber.youngs_modulus = 1e6;
  rubber.poisson_ratio = 0.3;
  rubber.density = 1000;
  rubber.tensile_strength = 1e6;
  scene.materials.push_back(rubber);
  scene.gravity = Vec3{0, 0, -9.81};
  scene.colliders.emplace_back().shape = PlaneShape{};
  scene.colliders[0].friction = 0.5;
  scene.contact.emplace();
  if (sleep) scene.sleep.emplace();
  scene.timing.frames_per_second = 100;
  scene.timing.steps_per_frame = 1;
  return scene;
}

// Seconds of a step, after the blocks on the ground have come to rest.
absl::StatusOr<double> StepSeconds(const TetMesh& mesh, bool sleep, int64_t wanted) {
  constexpr int kSettle = 60, kMeasured = 10;
  CLEAVE_ASSIGN_OR_RETURN(const auto simulation, Simulation::Create(OnTheGround(sleep), mesh, {}));
  const StopFlag stop;
  double seconds = 0;
  for (int frame = 0; frame < kSettle + kMeasured; ++frame) {
    CLEAVE_ASSIGN_OR_RETURN(const FrameReport report, simulation->Advance(stop));
    if (frame < kSettle) continue;
    if (sleep && report.sleeping_pieces != wanted)
      return absl::InternalError("the blocks did not fall asleep");
    seconds += report.total_seconds / kMeasured;
  }
  return seconds;
}

}  // namespace

absl::Status PrintSleep() {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  std::printf("\nA step of %d blocks that lie on the ground, one thread.\n\n", kPieces);
  std::printf("%-28s %8s %10s %10s %8s\n", "", "tets", "awake s", "asleep s", "ratio");
  for (const bool all : {true, false}) {
    CLEAVE_ASSIGN_OR_RETURN(const TetMesh mesh, Blocks(all ? 0 : 5));
    CLEAVE_ASSIGN_OR_RETURN(const double awake, StepSeconds(mesh, false, 0));
    CLEAVE_ASSIGN_OR_RETURN(const double asleep,
                            StepSeconds(mesh, true, all ? kPieces : kPieces - 1));
    std::printf("%-28s %8lld %10.5f %10.5f %8.4f\n",
                all ? "all of them asleep" : "all but one, which falls",
                static_cast<long long>(mesh.tet_count()), awake, asleep, asleep / awake);
  }
  return absl::OkStatus();
}

}  // namespace cleave
