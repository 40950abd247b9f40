#ifndef CLEAVE_SERVER_GATEWAY_HOSTED_SESSION_H_
#define CLEAVE_SERVER_GATEWAY_HOSTED_SESSION_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "absl/status/status.h"
#include "cleave/v1/session.pb.h"
#include "cleave/worker/v1/control.pb.h"
#include "cleave/worker/v1/records.pb.h"
#include "server/gateway/rung_encoders.h"
#include "server/gateway/worker_process.h"
#include "server/session/frame_log.h"
#include "server/session/session_paths.h"

namespace cleave {

// How sessions get their workers.
struct WorkerOptions {
  std::string program;  // path of cleave-worker
  int threads = 0;      // of a worker whose session does not say; 0: the worker's default
};

// A session as the gateway sees it: its directory, and a worker while one is needed. Functions
// return at once unless they say otherwise; what they begin shows in state(). Thread-safe.
class HostedSession : public std::enable_shared_from_this<HostedSession> {
 public:
  using Done = std::function<void(absl::Status)>;
  using ObserverId = uint64_t;

  // `options` must outlive the session.
  HostedSession(SessionPaths paths, worker::v1::SessionConfig config, const WorkerOptions& options);

  // Reads where the session stands; one that has an unfinished goal gets a worker. Waits for the
  // disk. Call once, first.
  absl::Status Load();

  const SessionPaths& paths() const { return paths_; }
  const worker::v1::SessionConfig& config() const { return config_; }
  std::string name() const { return "sessions/" + config_.session_id(); }
  FrameLogReader& frames() { return frames_; }
  // Coarser encodings of the frames. Precondition: Load.
  RungEncoders& rungs() { return *rungs_; }

  // What others decide by.
  struct State {
    v1::SessionState state = v1::SESSION_STATE_UNSPECIFIED;
    int64_t head_frame = -1;
    bool active = false;  // works, or is about to: frames may come without another call
    bool deleted = false;
    v1::Error error;
  };
  State state() const;
  v1::Session View(bool with_scene) const;

  // Gives the session a worker if it has none. Waits for the process to start.
  absl::Status StartWorker();

  // Starts working towards a goal that names its frame. `done` comes when the goal is durable.
  // Waits for a process to start where there is none.
  void Run(const v1::RunGoal& goal, const std::string& request_id, Done done);
  // Ends the goal in force. `done` comes when that is durable; the session is then PAUSING or
  // rests.
  void Pause(bool abort_step, Done done);

  // Ends the workers by force; `removable` is called once nobody writes to the directory any more.
  void Delete(std::function<void()> removable);
  // Lets its workers save and exit, and starts no others.
  void Shutdown();
  // Waits for the workers' end; false, and ends them by force, when some have not by `deadline`.
  bool WaitForWorkers(std::chrono::steady_clock::time_point deadline);

  // Calls `changed` after every change of state() and of a rung's, from any thread, with no lock
  // held; it must return at once. After Forget returned, a call may still be under way.
  ObserverId Observe(std::function<void()> changed);
  void Forget(ObserverId observer);

  void AddViewer(int count);

 private:
  // All need mutex_.
  absl::Status StartWorkerLocked();
  std::shared_ptr<WorkerProcess> WorkerLocked(absl::Status& status);
  bool EndedLocked() const { return worker_ == nullptr && rungs_->ended(); }

  void OnStatus(const worker::v1::Status& status);
  void OnExit(const std::string& how);
  void OnRungsChanged();
  void OnRunAcknowledged(const v1::RunGoal& goal, const absl::Status& status);
  void Notify();

  const SessionPaths paths_;
  const worker::v1::SessionConfig config_;
  const WorkerOptions& options_;
  FrameLogReader frames_;
  std::shared_ptr<RungEncoders> rungs_;

  mutable std::mutex mutex_;
  std::condition_variable workers_ended_;
  worker::v1::Status status_;
  std::shared_ptr<WorkerProcess> worker_;
  int runs_in_flight_ = 0;   // sent, not acknowledged
  int restarts_ = 0;         // since a frame was committed
  int64_t start_head_ = -1;  // head when the worker was started
  bool deleted_ = false;
  bool shutting_down_ = false;
  std::function<void()> removable_;
  int viewers_ = 0;

  std::mutex observers_mutex_;
  ObserverId last_observer_ = 0;
  std::map<ObserverId, std::shared_ptr<std::function<void()>>> observers_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_HOSTED_SESSION_H_
