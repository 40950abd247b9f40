#ifndef CLEAVE_SERVER_WORKER_RECORDED_SIMULATION_H_
#define CLEAVE_SERVER_WORKER_RECORDED_SIMULATION_H_

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/v1/session.pb.h"
#include "core/base/stop_flag.h"
#include "core/base/vec3.h"
#include "core/simulation/simulation.h"
#include "core/stream/frame_encoder.h"
#include "server/session/checkpoints.h"
#include "server/session/event_log.h"
#include "server/session/frame_log.h"
#include "server/session/reports.h"
#include "server/worker/session_inputs.h"

namespace cleave {

// A simulation bound to its session directory: frames go to the log as they are made, and what the
// directory holds decides where it stands. Not thread-safe.
class RecordedSimulation {
 public:
  // Builds the model and opens the log; simulates nothing. The caller owns the directory
  // (owner_lock.h).
  static absl::StatusOr<std::unique_ptr<RecordedSimulation>> Open(const SessionPaths& paths,
                                                                  SessionInputs inputs,
                                                                  int threads);

  // Newest committed frame, -1 before Begin.
  int64_t head() const { return log_.head(); }
  // Where the simulation stands: at head() except while it catches up.
  int64_t frame() const { return simulation_->frame(); }

  // Starts from the newest checkpoint that is whole, or from rest; commits frame 0 where the log is
  // empty. Afterwards frame() <= head(), and CatchUp brings it to head().
  absl::Status Begin();
  // Simulates a committed frame once more. Errors: those of Simulation::Advance; DataLoss when the
  // frame does not come out as it was committed, to the bit.
  absl::Status CatchUp(const StopFlag& stop);

  // Simulates the frame after head(). Errors: those of Simulation::Advance.
  absl::StatusOr<FrameReport> Advance(const StopFlag& stop);
  // Commits the frame that Advance made, and a checkpoint where one is due. After an error the
  // object is of no more use; the directory is as before.
  absl::Status Commit(const FrameReport& report);
  // Saves the state unless the newest checkpoint is of this frame.
  absl::Status Checkpoint();

 private:
  RecordedSimulation(Checkpoints checkpoints, FrameLogWriter log, Reports reports,
                     EventLogWriter events)
      : checkpoints_(std::move(checkpoints)),
        log_(std::move(log)),
        reports_(std::move(reports)),
        events_(std::move(events)) {}

  absl::Status RestoreNewestCheckpoint();
  absl::Status RestoreEncoder();
  Frame CurrentFrame() const;
  StreamMesh mesh() const { return {rest_positions_, edges_}; }

  Checkpoints checkpoints_;
  FrameLogWriter log_;
  Reports reports_;
  EventLogWriter events_;
  std::vector<Vec3> rest_positions_;
  std::vector<std::array<int32_t, 2>> edges_;  // of the mesh, as frames number them
  v1::FrameEvents whole_pieces_;               // where the log is empty
  std::string in_force_;                       // as every report line repeats it
  StreamHeader header_;
  int64_t checkpoint_interval_ = 1;
  int64_t newest_checkpoint_ = -1;
  std::unique_ptr<Simulation> simulation_;
  std::optional<FrameEncoder> encoder_;
};

// The numbers of a report that a display shows.
v1::Progress ProgressOf(const FrameReport& report);

// What the numbers of a run rest on, as a JSON object: precision and tolerances, step, what the
// scene has besides a body, elastic laws, and the settings of damping, fracture and impurities
// where it has them.
std::string InForce(const Scene& scene);
// A report as a line of JSON, without its newline. `in_force` is InForce of its scene.
std::string ReportLine(const FrameReport& report, absl::string_view in_force);

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_RECORDED_SIMULATION_H_
