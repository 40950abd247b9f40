#ifndef CLEAVE_CORE_SIMULATION_SIMULATION_H_
#define CLEAVE_CORE_SIMULATION_SIMULATION_H_

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/base/stop_flag.h"
#include "core/base/vec3.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"
#include "core/simulation/frame_events.h"

namespace cleave {

// Where a collider is: a point that the scene puts at X is at rotation * X + translation.
struct ColliderPlace {
  std::array<double, 4> rotation{1, 0, 0, 0};  // unit quaternion: w, x, y, z
  Vec3 translation{0, 0, 0};                   // m
};

// What one frame took and reached. Sums over the frame's steps unless a field says otherwise.
struct FrameReport {
  int64_t frame = 0;
  double time = 0;    // s, at the end of the frame
  int32_t steps = 0;  // halved steps included
  int32_t step_halvings = 0;
  double shortest_step = 0;  // s, that was taken
  int32_t newton_iterations = 0;
  int32_t linear_iterations = 0;
  int32_t break_passes = 0;
  double residual = 0;              // worst relative force residual at which a solve stopped
  double kinetic_energy = 0;        // J, at the end
  double elastic_energy = 0;        // J, at the end
  double external_work = 0;         // J, by gravity, motions and loads, since the start
  double fracture_energy = 0;       // J, elastic energy lost to breaking, since the start
  double plastic_work = 0;          // J, elastic energy lost to plastic flow, since the start
  double contact_energy = 0;        // J, stored where bodies touch, at the end
  double friction_dissipation = 0;  // J, since the start
  double damping_dissipation = 0;   // J, by Rayleigh damping, since the start
  // J, what time integration took out, since the start. External work is the change of kinetic,
  // elastic and contact energy, and what fracture, plastic flow, friction, damping and integration
  // took out.
  double integration_dissipation = 0;
  int64_t broken_edges = 0;                // since the start
  int64_t new_broken_edges = 0;            // in this frame
  int64_t fragments = 0;                   // node components through unbroken edges, at the end
  std::optional<int64_t> sleeping_pieces;  // of these, at the end; absent where none may sleep
  std::vector<Vec3> motion_forces;       // N, force that each motion exerts on the body, at the end
  std::vector<ColliderPlace> colliders;  // at the end, in the scene's order
  FrameEvents events;                    // what broke in this frame
  double assembly_seconds = 0;
  double linear_solve_seconds = 0;
  double fracture_seconds = 0;
  double total_seconds = 0;
};

// One body being simulated: created from a scene, advanced a frame at a time, saved and restored.
// Not thread-safe; it runs its loops on its own TBB arena. Same scene, mesh and build give the same
// bits for any thread count.
class Simulation {
 public:
  struct Options {
    int threads = 1;
  };

  // Preconditions: ValidateScene and ValidateSceneWithMesh hold and `mesh` passed CheckMesh; its
  // positions are in metres (unit_scale is already applied). Errors: InvalidArgument,
  // ResourceExhausted.
  static absl::StatusOr<std::unique_ptr<Simulation>> Create(const Scene& scene, TetMesh mesh,
                                                            const Options& options);
  virtual ~Simulation() = default;

  // Advances by one frame. Errors: Cancelled when `stop` was requested, also in the middle of a
  // linear solve; Aborted when a step does not converge at the smallest dt, naming the worst node.
  // After an error the state is that of the last whole frame.
  virtual absl::StatusOr<FrameReport> Advance(const StopFlag& stop) = 0;

  // The last whole frame, 0 before the first Advance, in the client's node and edge ids
  // (core/mesh/incidence.h numbers edges).
  virtual int64_t frame() const = 0;
  virtual double time() const = 0;                               // s
  virtual const std::vector<Vec3>& positions() const = 0;        // m; unreferenced nodes rest
  virtual const std::vector<int32_t>& broken_edges() const = 0;  // ascending
  virtual int64_t fragments() const = 0;  // node components through unbroken edges
  // Equivalent plastic strains, a tet each, in the client's order; empty where nothing is ductile.
  virtual std::vector<double> plastic_strains() const = 0;

  // Everything that decides the frames to come. Restore refuses (DataLoss, FailedPrecondition)
  // bytes that are damaged or of another scene, mesh or format, and then changes nothing.
  virtual std::string Save() const = 0;
  virtual absl::Status Restore(absl::string_view saved) = 0;

  // XXH3 of the saved state: equal exactly when the runs are the same so far.
  virtual uint64_t state_hash() const = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SIMULATION_SIMULATION_H_
